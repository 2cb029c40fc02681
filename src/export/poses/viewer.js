// Shows the poses of a ligand at a protein. The data: `protein`, a PDB file; `reference`, an SDF record or null; for every
// pose its `sdf`, its `colour`, and its way out: the coordinates of its atoms in every frame as whole multiples of `unit` in 16
// bits, x y z, and `told`, how far along and with which energy.
(() => {
  const element = (id) => document.getElementById(id);
  const data = JSON.parse(element("data").textContent);
  const box = element("viewer");
  const rows = [...document.querySelectorAll("tr[data-pose]")];
  const points = [...document.querySelectorAll("circle.pose")];
  const ways = [...document.querySelectorAll(".way")];
  const framesOf = (pose) => data.poses[pose].told.length;
  let chosen = 0;

  // Of a way out: the coordinates of all frames, once they are wanted.
  const decoded = data.poses.map(() => null);
  const coordinates = (pose) => {
    if (decoded[pose] === null) {
      const bytes = atob(data.poses[pose].coordinates);
      const numbers = new Int16Array(bytes.length / 2);
      for (let i = 0; i < numbers.length; i++) {
        numbers[i] = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
      }
      decoded[pose] = numbers;
    }
    return decoded[pose];
  };

  // What of the page shows which pose is chosen, and where on its way out.
  const mark = () => {
    const isChosen = (one) => Number(one.dataset.pose) === chosen;
    for (const one of [...rows, ...points, ...ways]) one.classList.toggle("chosen", isChosen(one));
    for (const row of rows) row.setAttribute("aria-selected", isChosen(row));
    element("way").hidden = framesOf(chosen) === 0;
    element("no-way").hidden = framesOf(chosen) > 0;
  };
  const tell = () => {
    const frame = Number(element("frame").value);
    const cursor = ways.find((one) => Number(one.dataset.pose) === chosen)?.querySelector(".cursor");
    if (!cursor) return;
    const [x, y] = cursor.dataset.places.split(" ")[frame].split(",");
    cursor.setAttribute("cx", x);
    cursor.setAttribute("cy", y);
    const [along, energy] = data.poses[chosen].told[frame];
    element("told").textContent = `${along} Å along, energy ${energy} kJ/mol, frame ${frame + 1} of ${framesOf(chosen)}`;
  };

  let viewer = null;
  try {
    viewer = $3Dmol.createViewer(box, { backgroundColor: "white", antialias: true, cartoonQuality: 8 });
  } catch (error) {
    viewer = null;
  }
  if (!viewer) box.innerHTML = "<p>This browser shows no WebGL, without which the structures cannot be drawn.</p>";
  // The page's policy forbids threads.
  if (viewer) $3Dmol.setSyncSurface(true);

  // Modified residues are part of the chain, and of its ribbon: those that have the backbone's atoms.
  const lines = data.protein.split("\n");
  const residueOf = (line) => line.slice(17, 27);
  const residuesWith = (name) => new Set(lines.filter((line) => line.slice(12, 16) === name).map(residueOf));
  const backbone = [" N  ", " CA ", " C  "].map(residuesWith);
  const asChain = (line) =>
    line.startsWith("HETATM") && backbone.every((residues) => residues.has(residueOf(line))) ? "ATOM  " + line.slice(6) : line;
  const protein = viewer?.addModel(lines.map(asChain).join("\n"), "pdb");
  const models = viewer ? data.poses.map((pose) => viewer.addModel(pose.sdf, "sdf")) : [];
  const reference = viewer && data.reference !== null ? viewer.addModel(data.reference, "sdf") : null;
  element("has-reference").hidden = data.reference === null;
  const placesOf = (model) => model.selectedAtoms({}).map((atom) => [atom.x, atom.y, atom.z]);
  const home = models.map(placesOf);

  const sticks = (carbon, radius, opacity) => ({
    stick: { radius, opacity, colorscheme: { prop: "elem", map: { ...$3Dmol.elementColors.defaultColors, C: carbon } } },
  });
  const waters = ["HOH", "WAT", "DOD", "H2O", "SOL"];
  const isMetal = { elem: ["Na", "NA", "Mg", "MG", "K", "Ca", "CA", "Mn", "MN", "Fe", "FE", "Co", "CO", "Ni", "NI", "Cu", "CU", "Zn", "ZN"], hetflag: true };

  // The numbers of the protein's atoms in whole residues of which one atom is within a distance of the pose.
  const near = (distance) => {
    const places = home[chosen];
    const isNear = (atom) =>
      places.some(([x, y, z]) => (atom.x - x) ** 2 + (atom.y - y) ** 2 + (atom.z - z) ** 2 <= distance ** 2);
    const atoms = protein.selectedAtoms({ hetflag: false });
    const key = (atom) => `${atom.chain} ${atom.resi} ${atom.icode ?? ""}`;
    const residues = new Set(atoms.filter(isNear).map(key));
    return atoms.filter((atom) => residues.has(key(atom))).map((atom) => atom.serial);
  };

  let surface = null;
  const drawProtein = () => {
    const kind = element("protein").value;
    protein.setStyle({}, {});
    const ribbon = { color: "#dfe4e8", opacity: 0.8, ...(kind === "trace" ? { style: "trace" } : { arrows: true, thickness: 0.25 }) };
    if (kind !== "none") protein.setStyle({ hetflag: false }, { cartoon: ribbon });
    protein.setStyle({ ...isMetal, not: { resn: waters } }, { sphere: { scale: 0.35 } });
    if (surface !== null) viewer.removeSurface(surface);
    surface = null;
    const pocket = element("pocket").value;
    if (pocket === "none") return;
    const select = { serial: near(4.5), hetflag: false };
    if (select.serial.length === 0) return;
    // Hydrogens of the protein would hide the ligand.
    protein.setStyle({ ...select, not: { elem: "H" } }, { ...(kind === "none" ? {} : { cartoon: ribbon }), ...sticks("#aab2b8", 0.11, 1) });
    if (pocket === "surface") {
      const wide = { serial: near(7), hetflag: false, model: protein };
      const made = viewer.addSurface($3Dmol.SurfaceType.VDW, { color: "#d5dade", opacity: 0.72 }, { ...select, model: protein }, wide);
      Promise.resolve(made).then((id) => {
        surface = id;
        viewer.render();
      });
    }
  };
  const drawPoses = () => {
    const hasOthers = element("others").checked;
    models.forEach((model, pose) => {
      const { colour } = data.poses[pose];
      if (pose === chosen) model.setStyle({}, sticks(colour, 0.22, 1));
      else {
        model.setStyle({}, {});
        if (hasOthers) model.setStyle({ not: { elem: "H" } }, sticks(colour, 0.06, 1));
      }
    });
    reference?.setStyle({}, element("reference").checked ? sticks("#5d646b", 0.1, 1) : {});
  };
  // The ligand where it is on its way out; other poses stand where they belong.
  const place = () => {
    const frame = Number(element("frame").value);
    models.forEach((model, pose) => {
      const isOnWay = pose === chosen && framesOf(pose) > 0;
      const atoms = model.selectedAtoms({});
      atoms.forEach((atom, at) => {
        if (isOnWay) {
          const start = 3 * (atoms.length * frame + at);
          const of = (axis) => (coordinates(pose)[start + axis] ?? 0) * data.poses[pose].unit;
          [atom.x, atom.y, atom.z] = [of(0), of(1), of(2)];
        } else {
          [atom.x, atom.y, atom.z] = home[pose][at];
        }
      });
    });
  };
  // The line along which the middle of the ligand goes.
  const drawWay = () => {
    viewer.removeAllShapes();
    const frames = framesOf(chosen);
    const count = home[chosen].length;
    const middle = (frame) => {
      const sum = [0, 0, 0];
      for (let at = 0; at < 3 * count; at++) sum[at % 3] += coordinates(chosen)[3 * count * frame + at] ?? 0;
      const [x, y, z] = sum.map((value) => (value * data.poses[chosen].unit) / count);
      return { x, y, z };
    };
    for (let frame = 1; frame < frames; frame++) {
      viewer.addCylinder({ start: middle(frame - 1), end: middle(frame), radius: 0.07, fromCap: 1, toCap: 1, color: data.poses[chosen].colour, opacity: 0.75 });
    }
  };
  const render = () => {
    if (!viewer) return;
    place();
    drawPoses();
    viewer.render();
  };
  // Looks at the pose from where its way leads or, without one, from outside of the protein, a little from the side.
  const middleOf = (places) =>
    [0, 1, 2].map((axis) => places.reduce((sum, place) => sum + place[axis], 0) / Math.max(1, places.length));
  const centre = () => {
    if (!viewer) return;
    const serial = near(4.5);
    viewer.zoomTo(serial.length > 0 ? { model: protein, serial, hetflag: false } : { model: models[chosen] });
    viewer.zoom(1.3);
    const here = middleOf(home[chosen]);
    const frames = framesOf(chosen);
    let there = null;
    if (frames > 1) {
      const numbers = [...coordinates(chosen).slice(3 * home[chosen].length * (frames - 1))];
      const last = [0, 1, 2].map((axis) => numbers.filter((_, at) => at % 3 === axis));
      there = last.map((values) => (values.reduce((sum, value) => sum + value, 0) * data.poses[chosen].unit) / Math.max(1, values.length));
    } else {
      const inside = middleOf(placesOf(protein));
      there = here.map((value, axis) => 2 * value - inside[axis]);
    }
    const unit = (vector) => {
      const length = Math.hypot(...vector);
      return length > 0 ? vector.map((value) => value / length) : [0, 0, 1];
    };
    const [from, to] = [unit(there.map((value, axis) => value - here[axis])), unit([0.45, 0.4, 0.8])];
    // The quaternion of the shortest rotation of one direction to the other; opposite ones have none of their own.
    const dot = from[0] * to[0] + from[1] * to[1] + from[2] * to[2];
    const cross = [0, 1, 2].map((axis) => from[(axis + 1) % 3] * to[(axis + 2) % 3] - from[(axis + 2) % 3] * to[(axis + 1) % 3]);
    const length = Math.hypot(...cross, 1 + dot);
    const turn = length > 1e-6 ? [...cross, 1 + dot].map((value) => value / length) : [0, 1, 0, 0];
    viewer.setView([...viewer.getView().slice(0, 4), ...turn]);
  };

  const { begin } = player(() => {
    tell();
    render();
  }, 90);
  const choose = (pose) => {
    chosen = pose;
    begin(framesOf(pose));
    mark();
    tell();
    if (viewer) {
      drawProtein();
      drawWay();
      centre();
    }
    render();
  };

  for (const one of [...rows, ...points]) {
    const pose = Number(one.dataset.pose);
    one.onclick = () => choose(pose);
    one.onkeydown = (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      choose(pose);
    };
  }
  for (const id of ["protein", "pocket"]) {
    element(id).onchange = () => {
      if (viewer) drawProtein();
      render();
    };
  }
  for (const id of ["others", "reference"]) element(id).onchange = render;
  element("centre").onclick = () => {
    centre();
    render();
  };
  element("save").onclick = () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([data.poses[chosen].sdf], { type: "chemical/x-mdl-sdfile" }));
    link.download = `pose-${chosen + 1}.sdf`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  choose(0);
})();
