// The controls, and what the address asks for: #frame=100 on a path, #node=7, #stop=3, #colours=energy, #robots, #path=1, #draw,
// #view=TURN,TILT,AWAY; several are joined by &.
function fillControls() {
  document.querySelector("#panel summary").textContent = data.name;
  choices("colours", [["component", "component"], ...measures().map(({ name, unit }, i) =>
    [String(i), unit ? name + " [" + unit + "]" : name])], state.colours);
  choices("path", data.paths.map(({ name }, i) => [String(i), name]), state.path);
  element("show-robots").parentElement.hidden = !data.links.length;
  element("show-obstacles").parentElement.hidden = !data.obstacles.length;
}
element("stop").addEventListener("input", () => { state.stop = +element("stop").value; recolour(); tellAll(); });
element("colours").addEventListener("change", () => { state.colours = element("colours").value; recolour(); tellAll(); });
for (const id of ["show-nodes", "show-edges", "show-robots", "show-obstacles"]) element(id).addEventListener("change", tellAll);
element("home").addEventListener("click", () => { eye = home(); repaint(); });
new ResizeObserver(repaint).observe(canvas);

function obey(address) {
  const asked = new Map(address.slice(1).split("&").map((part) => part.split("=")).map(([key, value]) => [key, value]));
  const number = (key, least, most) => {
    const value = Number(asked.get(key));
    return asked.has(key) && Number.isFinite(value) ? within(value, [least, most]) : null;
  };
  const index = (key, count) => { const value = number(key, 0, count - 1); return value === null ? null : Math.floor(value); };
  if (data.paths.length) {
    state.path = index("path", data.paths.length) ?? 0;
    const frame = number("frame", 0, last());
    state.place = frame ?? 0;
    state.playing = frame === null && !graph;
  }
  if (graph) {
    state.stop = index("stop", graph.stops.length) ?? graph.stops.length - 1;
    state.chosen = index("node", graph.count) ?? -1;
    const colours = measures().findIndex(({ name }) => name === decodeURIComponent(asked.get("colours") || ""));
    if (colours >= 0) state.colours = String(colours);
    element("show-robots").checked = asked.has("robots");
  }
  if (asked.has("draw") && canDraw()) toggleHint();
  const [turn, tilt, away] = (asked.get("view") || "").split(",").map(Number);
  if ([turn, tilt, away].every(Number.isFinite) && asked.has("view"))
    Object.assign(eye, { turn, tilt: within(tilt, LIMITS.tilt), away: within(away, LIMITS.away) });
}
if (innerWidth <= 640) element("panel").open = false;
if (gl) {
  obey(location.hash);
  if (graph) recolour();
} else element("time").textContent = "this browser has no WebGL 2";
fillControls();
tellAll();
