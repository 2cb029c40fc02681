// The roadmap's nodes and edges.
const SOME = 4000;
let web = null;
function loadRoadmap() {
  if (web) for (const id of [web.points, web.pairs, web.some, web.colours]) gl.deleteBuffer(id);
  const [some, colours] = [gl.createBuffer(), gl.createBuffer()];
  web = { points: filled(graph.markers), pairs: filled(graph.pairs, gl.ELEMENT_ARRAY_BUFFER), some, colours };
  recolour();
}
function recolour() {
  if (!gl) return;
  gl.bindBuffer(gl.ARRAY_BUFFER, web.colours);
  web.tints = coloursAtStop();
  gl.bufferData(gl.ARRAY_BUFFER, web.tints, gl.DYNAMIC_DRAW);
  // Some edges of the stop, evenly, for quick pictures.
  const { shownEdges } = stopped(), step = Math.ceil(shownEdges / SOME) || 1;
  const some = [];
  for (let edge = 0; edge < shownEdges; edge += step) some.push(graph.pairs[2 * edge], graph.pairs[2 * edge + 1]);
  web.someCount = some.length;
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, web.some);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(some), gl.DYNAMIC_DRAW);
}
if (gl && graph) loadRoadmap();

// The more there is to draw, the fainter and smaller it is drawn.
function crowding() {
  const { shownNodes, shownEdges } = stopped();
  const nodes = within(shownNodes / 3000, [0, 1]), edges = within(Math.log10(1 + shownEdges / 300) / 2.5, [0, 1]);
  return { dot: 6 - 3.2 * nodes, edge: 0.62 - 0.52 * edges };
}
function useGraph(camera) {
  const { made, at } = programs.graph;
  gl.useProgram(made);
  gl.uniformMatrix4fv(at.camera, false, camera);
  gl.uniform1f(at.nearer, 0);
  return at;
}
// Dots of so many pixels of the page.
function drawDots(camera, places, tints, size) {
  const points = filled(new Float32Array(places.flat())), colours = filled(new Uint8Array(tints.flat()));
  const at = useGraph(camera);
  attributes(points, 12, [[0, 3, 0]]);
  attributes(colours, 4, [[1, 4, 0, 0, gl.UNSIGNED_BYTE]]);
  gl.uniform1f(at.opacity, 1);
  gl.uniform1i(at.dots, 1);
  gl.uniform1f(at.size, size * pixels());
  gl.drawArrays(gl.POINTS, 0, places.length);
  gl.deleteBuffer(points);
  gl.deleteBuffer(colours);
}
function drawRoadmap(camera) {
  if (!web) return;
  const at = useGraph(camera), { dot, edge } = crowding(), { shownNodes, shownEdges } = stopped();
  attributes(web.points, 12, [[0, 3, 0]]);
  attributes(web.colours, 4, [[1, 4, 0, 0, gl.UNSIGNED_BYTE]]);
  gl.depthMask(false);
  if (element("show-edges").checked && shownEdges) {
    gl.uniform1f(at.opacity, edge);
    gl.uniform1i(at.dots, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, isCoarse ? web.some : web.pairs);
    gl.drawElements(gl.LINES, isCoarse ? web.someCount : 2 * shownEdges, gl.UNSIGNED_INT, 0);
  }
  if (element("show-nodes").checked && shownNodes) {
    gl.uniform1f(at.opacity, 0.9);
    gl.uniform1i(at.dots, 1);
    gl.uniform1f(at.size, dot * pixels());
    gl.drawArrays(gl.POINTS, 0, shownNodes);
  }
  gl.depthMask(true);
}

// The node whose marker is nearest on the screen to a place in the page, if one is near.
const NEAR = 26;
function nodeAt(x, y) {
  if (!graph || !element("show-nodes").checked && !element("show-edges").checked) return -1;
  const { camera: c } = look(), { markers } = graph, { shownNodes } = stopped();
  const [wide, high_] = [canvas.clientWidth, canvas.clientHeight];
  let [best, nearest] = [-1, NEAR * NEAR];
  for (let i = 0; i < shownNodes; i++) {
    const [px, py, pz] = [markers[3 * i], markers[3 * i + 1], markers[3 * i + 2]];
    const w = c[3] * px + c[7] * py + c[11] * pz + c[15];
    if (w <= 0) continue;
    const dx = (0.5 + 0.5 * (c[0] * px + c[4] * py + c[8] * pz + c[12]) / w) * wide - x;
    const dy = (0.5 - 0.5 * (c[1] * px + c[5] * py + c[9] * pz + c[13]) / w) * high_ - y;
    const from = dx * dx + dy * dy;
    if (from < nearest) [best, nearest] = [i, from];
  }
  return best;
}
