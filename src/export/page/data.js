// What the page shows: the scene, paths, and a roadmap if there is one.
let data = JSON.parse(element("data").textContent);

// A roadmap with its columns. A stop is the end of a round: how many rounds, sets, nodes, edges and components there are
// until then, and how many nodes and edges of them the page has.
function decoded(roadmap) {
  if (!roadmap) return null;
  const ids = column(roadmap.ids, Uint32Array);
  const stops = roadmap.stops.map(([rounds, sets, nodes, edges, components, shownNodes, shownEdges]) =>
    ({ rounds, sets, nodes, edges, components, shownNodes, shownEdges }));
  return {
    nodes: roadmap.nodes, edges: roadmap.edges, rounds: roadmap.rounds, whole: roadmap.whole, stops, ids,
    count: ids.length,
    markers: column(roadmap.markers, Float32Array),
    configs: column(roadmap.configs, Float32Array),
    poses: column(roadmap.poses, Float32Array),
    components: column(roadmap.components, Uint32Array),
    degrees: column(roadmap.degrees, Uint32Array),
    pairs: column(roadmap.pairs, Uint32Array),
    values: roadmap.values.map(({ name, unit, numbers }) =>
      ({ name, unit, numbers: column(numbers, Float32Array) })),
  };
}
let graph = decoded(data.roadmap);

// What is shown, as the controls and the pointer say.
const state = {
  stop: graph ? graph.stops.length - 1 : -1,
  colours: "component",
  hovered: -1,
  chosen: -1,
  path: 0,
  place: 0,
  playing: false,
};
const NOWHERE = { rounds: 0, sets: 0, nodes: 0, edges: 0, components: 0, shownNodes: 0, shownEdges: 0 };
const stopped = () => graph && graph.stops[state.stop] || NOWHERE;
const path = () => data.paths[state.path];
const last = () => path() ? path().frames.length - 1 : 0;
