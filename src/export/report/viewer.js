// Plays the paths of the report as structures. The data: `pdb`, the start with the atoms that are kept; for every path the
// coordinates of these atoms in every frame, as whole multiples of `unit` in 16 bits, x y z; `told`, what stands beside the
// slider at each frame; `motion`, how far the Cα of each residue moves between the ends.
(() => {
  const element = (id) => document.getElementById(id);
  const box = element("viewer");
  const data = JSON.parse(element("data").textContent);
  const lines = data.pdb.split("\n");
  const isAtom = (line) => line.startsWith("ATOM") || line.startsWith("HETATM");
  const atoms = lines.filter(isAtom).length;

  const decode = (text) => {
    const bytes = atob(text);
    const numbers = new Int16Array(bytes.length / 2);
    for (let i = 0; i < numbers.length; i++) {
      numbers[i] = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
    }
    return numbers;
  };
  const decoded = data.paths.map(() => null);
  const coordinates = (path) => (decoded[path] ??= decode(data.paths[path].coordinates));
  const framesOf = (path) => data.paths[path].told.length;

  // A PDB file of a path, its frames as models.
  const pdbOf = (path) => {
    const numbers = coordinates(path);
    let [at, text] = [0, ""];
    for (let frame = 0; frame < framesOf(path); frame++) {
      text += `MODEL     ${String(frame + 1).padStart(4)}\n`;
      for (const line of lines) {
        if (!isAtom(line)) {
          text += line === "" ? "" : line + "\n";
          continue;
        }
        const places = [0, 1, 2].map((axis) => (numbers[at + axis] * data.unit).toFixed(3).padStart(8));
        at += 3;
        text += line.slice(0, 30) + places.join("") + line.slice(54) + "\n";
      }
      text += "ENDMDL\n";
    }
    return text + "END\n";
  };

  data.paths.forEach((path, index) => element("path").add(new Option(`${index + 1}`, index)));
  element("save").onclick = () => {
    const path = Number(element("path").value);
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([pdbOf(path)], { type: "chemical/x-pdb" }));
    link.download = `path-${path + 1}.pdb`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };

  let viewer = null;
  try {
    viewer = $3Dmol.createViewer(box, { backgroundColor: "white", antialias: true });
  } catch (error) {
    viewer = null;
  }
  if (!viewer) {
    box.innerHTML = "<p>This browser shows no WebGL, without which the structures cannot be drawn.</p>";
    return;
  }

  // Which residue of the moving chain each atom is of; other chains, which stand still, have none.
  const residueOf = [];
  let [residue, last, isFirstChain] = [-1, "", true];
  for (const line of lines) {
    if (line.startsWith("TER")) isFirstChain = false;
    if (!isAtom(line)) continue;
    const name = line.slice(21, 27);
    if (name !== last) residue++;
    last = name;
    residueOf.push(isFirstChain ? residue : -1);
  }

  // Modified residues are part of the chain, and of its ribbon.
  const chain = data.pdb.replace(/^HETATM/gm, "ATOM  ");
  const model = () => viewer.addModel(chain, "pdb");
  const [moving, start, goal] = [model(), model(), model()];
  const place = (which, path, frame) => {
    const numbers = coordinates(path);
    let at = 3 * atoms * frame;
    for (const atom of which.selectedAtoms({})) {
      atom.x = numbers[at++] * data.unit;
      atom.y = numbers[at++] * data.unit;
      atom.z = numbers[at++] * data.unit;
    }
  };

  const mix = (share) => {
    const part = (from, to) => Math.round(from + (to - from) * share);
    return (part(0xd9, 0xc1) << 16) | (part(0xd9, 0x1f) << 8) | part(0xd9, 0x0e);
  };
  const byMotion = (atom) => {
    const moved = data.motion[residueOf[atom.index]];
    return moved === undefined ? 0x999999 : mix(data.largest > 0 ? moved / data.largest : 0);
  };
  const drawn = (colouring, opacity) => {
    const kind = element("style").value;
    const common = { ...colouring, opacity };
    if (kind === "stick") return { stick: { ...common, radius: 0.15 } };
    return { cartoon: kind === "trace" ? { ...common, style: "trace" } : common };
  };
  const colouring = (path) => {
    switch (element("colours").value) {
      case "chain":
        return { color: "spectrum" };
      case "motion":
        return { colorfunc: byMotion };
      default:
        return { color: data.paths[path].colour };
    }
  };

  const show = () => {
    const path = Number(element("path").value);
    const frame = Number(element("frame").value);
    place(moving, path, frame);
    moving.setStyle({}, drawn(colouring(path), 1));
    const hasEnds = element("show-ends").checked;
    start.setStyle({}, hasEnds ? drawn({ color: data.ends[0] }, 0.6) : {});
    goal.setStyle({}, hasEnds ? drawn({ color: data.ends[1] }, 0.6) : {});
    viewer.render();
    const [number, length, energy, fromStart, fromGoal] = data.paths[path].told[frame];
    element("told").textContent =
      `frame ${number}, ${length} Å along, energy ${energy}, ${fromStart} Å from the start (grey), ${fromGoal} Å from the goal (yellow)`;
  };
  // About twelve frames a second.
  const { begin } = player(show, 80);
  const choose = () => {
    const path = Number(element("path").value);
    begin(framesOf(path));
    place(start, path, 0);
    place(goal, path, framesOf(path) - 1);
    show();
    viewer.zoomTo();
    viewer.render();
  };
  element("path").onchange = choose;
  for (const id of ["style", "colours", "show-ends"]) element(id).onchange = show;
  choose();
})();
