// What is said in words: about the roadmap, and about the configuration that is looked at.
const counted = (count, noun) =>
  count.toLocaleString("en").replace(/,/g, "\u2009") + " " + noun + (count === 1 ? "" : "s");
const rounded = (x) => Math.abs(x) >= 1e5 || x !== 0 && Math.abs(x) < 1e-3 ? x.toExponential(2) : String(+x.toPrecision(4));

function tellRoadmap() {
  element("panel").hidden = !graph;
  if (!graph) return;
  const { shownNodes, shownEdges, nodes, edges, components, rounds } = stopped();
  const share = (shown, all, noun) => shown === all ? counted(all, noun) : counted(shown, noun).split(" ")[0] + " of " + counted(all, noun);
  element("counts").textContent = share(shownNodes, nodes, "node") + ", " + share(shownEdges, edges, "edge")
    + (shownNodes < nodes || shownEdges < edges ? " drawn" : "");
  element("stop").max = graph.stops.length - 1;
  element("stop").value = state.stop;
  element("growth").hidden = graph.stops.length < 2;
  element("extent").textContent = "round " + rounds + " of " + graph.rounds + ": " + counted(components, "component");
  const measure = measures()[state.colours];
  element("legend").hidden = !measure;
  if (measure) {
    const [least, most] = rangeOf(measure);
    element("least").textContent = rounded(least);
    element("most").textContent = rounded(most) + (measure.unit ? " " + measure.unit : "");
    element("ramp").style.background = "linear-gradient(to right,"
      + RAMP.map((rgb) => "rgb(" + rgb.join(",") + ")").join(",") + ")";
  }
  const notes = [];
  if (!graph.whole && !measure) notes.push("Not all nodes are in the page; colours are those of the components at the end.");
  if (element("show-robots").checked && crowdCount() < shownNodes)
    notes.push(counted(crowdCount(), "robot") + " drawn.");
  element("told").textContent = notes.join(" ");
}

function tellValues() {
  const node = pointed(), box = element("values");
  box.hidden = node < 0 && !path() && !hint.on;
  if (box.hidden) return;
  const rows = [];
  if (node >= 0) {
    const { configs, components, degrees, values, ids } = graph, count = data.dofs.length;
    box.querySelector("h1").textContent = "node " + ids[node];
    data.dofs.forEach(([name, unit], dof) => rows.push([name, configs[count * node + dof].toFixed(3), unitOf(name, unit)]));
    values.forEach(({ name, unit, numbers }) => rows.push([name, rounded(numbers[node]), unitOf(name, unit)]));
    rows.push(["component", String(graph.whole ? ids[componentsAtStop()[node]] : components[node]), ""],
      ["edges", String(degrees[node]), ""], ["round", String(measures().find(({ name }) => name === "round").of(node)), ""]);
  } else {
    const config = hint.on ? hint.now.config : path().configs[Math.round(state.place)];
    box.querySelector("h1").textContent = hint.on ? "hint" : graph ? path().name : data.name;
    data.dofs.forEach(([name, unit], dof) => rows.push([name, config[dof].toFixed(3), unitOf(name, unit)]));
  }
  const table = box.querySelector("table");
  while (table.rows.length > rows.length) table.deleteRow(-1);
  rows.forEach((texts, i) => {
    const row = table.rows[i] || table.insertRow();
    texts.forEach((text, k) => { (row.cells[k] || row.insertCell()).textContent = text; });
  });
}

function tellPath() {
  element("play").textContent = state.playing ? "Pause" : "Play";
  for (const id of ["play", "slider", "place", "speed"]) element(id).hidden = !path() || hint.on;
  element("path").hidden = data.paths.length < 2 || hint.on;
  if (!path()) return;
  element("slider").max = last();
  element("slider").value = state.place;
  const { length } = path();
  element("place").textContent = (length * state.place / last()).toFixed(2) + " of " + length.toFixed(2);
}

function tellAll() {
  tellRoadmap();
  tellValues();
  tellPath();
  tellHint();
  tellTouch();
  repaint();
}
// Fills a list of choices.
function choices(id, texts, chosen) {
  element(id).replaceChildren(...texts.map(([value, text]) => new Option(text, value, false, value === String(chosen))));
}
