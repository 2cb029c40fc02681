// By which colours nodes and edges are told apart.
const PALETTE = [[79, 126, 168], [63, 155, 108], [132, 96, 181], [201, 162, 31], [44, 159, 163], [192, 98, 158],
  [123, 138, 46], [107, 111, 201], [154, 106, 69]];
const ALONE = [128, 130, 134];
// From low to high (after viridis, with a last colour that shows on a light ground).
const RAMP = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 190, 80], [214, 178, 20]];
function ramp(share) {
  const at = within(share, [0, 1]) * (RAMP.length - 1), i = Math.min(Math.floor(at), RAMP.length - 2);
  return RAMP[i].map((x, k) => x + (RAMP[i + 1][k] - x) * (at - i));
}

// The unit of a number as it is shown: not where there is none, nor where it is the number's own name, as of a landscape's energy.
const unitOf = (name, unit) => unit === "1" || unit === name ? "" : unit;

// The numbers that nodes can be coloured by.
function measures() {
  if (!graph) return [];
  const dofs = data.dofs.map(([name, unit], dof) =>
    ({ name, unit: unitOf(name, unit), of: (node) => graph.configs[data.dofs.length * node + dof] }));
  const values = graph.values.map(({ name, unit, numbers }) =>
    ({ name, unit: unitOf(name, unit), of: (node) => numbers[node] }));
  const ends = graph.stops.map(({ shownNodes }) => shownNodes);
  const roundOf = (node) => {
    let [below, above] = [0, ends.length - 1];
    while (below < above) {
      const half = (below + above) >> 1;
      if (ends[half] > node) above = half; else below = half + 1;
    }
    return graph.stops[below].rounds;
  };
  return [...values, { name: "round", unit: "", of: roundOf },
    { name: "edges of the node", unit: "", of: (node) => graph.degrees[node] }, ...dofs];
}

// Per node the first node of its component, of the roadmap as it was at the stop; of a part of a roadmap as it is at the end.
function componentsAtStop() {
  const { shownNodes, shownEdges } = stopped(), { pairs } = graph;
  if (!graph.whole) return graph.components.subarray(0, shownNodes);
  const lower = new Uint32Array(shownNodes).map((_, i) => i);
  const lowest = (i) => {
    while (lower[i] !== i) i = lower[i] = lower[lower[i]];
    return i;
  };
  for (let edge = 0; edge < shownEdges; edge++) {
    const [a, b] = [lowest(pairs[2 * edge]), lowest(pairs[2 * edge + 1])];
    if (a < b) lower[b] = a; else lower[a] = b;
  }
  return lower.map((_, i) => lowest(i));
}

// Red, green, blue and opacity for each node of the stop.
function coloursAtStop() {
  const { shownNodes } = stopped(), colours = new Uint8Array(4 * shownNodes);
  const measure = measures()[state.colours];
  let tint;
  if (measure) {
    const [least, most] = rangeOf(measure);
    tint = (node) => ramp((measure.of(node) - least) / (most - least || 1));
  } else {
    const components = componentsAtStop(), sizes = new Map();
    for (const name of components) sizes.set(name, (sizes.get(name) || 0) + 1);
    const ranked = [...sizes].sort((a, b) => b[1] - a[1] || a[0] - b[0]);
    const colourOf = new Map(ranked.map(([name, count], rank) =>
      [name, count === 1 ? ALONE : rank === 0 ? PALETTE[0] : PALETTE[1 + (rank - 1) % (PALETTE.length - 1)]]));
    tint = (node) => colourOf.get(components[node]);
  }
  for (let node = 0; node < shownNodes; node++) {
    colours.set(tint(node), 4 * node);
    colours[4 * node + 3] = 255;
  }
  return colours;
}
function rangeOf(measure) {
  let [least, most] = [Infinity, -Infinity];
  for (let node = 0; node < graph.count; node++) {
    least = Math.min(least, measure.of(node));
    most = Math.max(most, measure.of(node));
  }
  return [least, most];
}
