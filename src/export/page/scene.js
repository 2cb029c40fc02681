// The scene: bounds, floor, obstacles, the robot's links, and of a landscape its energy.
const { min, max, low, high, planar } = data;
const size = Math.hypot(...sub(high, low)) || 1;
const middle = low.map((x, i) => (x + high[i]) / 2);
let floor = min[2];
if (planar) for (const { v } of [...data.obstacles, ...data.links.flat()])
  for (let i = 2; i < v.length; i += 3) floor = Math.min(floor, v[i]);
const corner = (i) => [(i & 1 ? max : min)[0], (i & 2 ? max : min)[1], (i & 4 ? max : min)[2]];

// Two triangles for every cell of the grid, which has points in rows from the least y to the largest.
function relief({ columns, energies }) {
  const values = column(energies, Float32Array), rows = values.length / columns;
  const points = new Float32Array(4 * values.length), corners = [];
  values.forEach((energy, i) => {
    const [x, y] = [i % columns / (columns - 1), Math.floor(i / columns) / (rows - 1)];
    points.set([min[0] + (max[0] - min[0]) * x, min[1] + (max[1] - min[1]) * y, floor, energy], 4 * i);
  });
  for (let y = 0; y + 1 < rows; y++) for (let x = 0; x + 1 < columns; x++) {
    const i = y * columns + x;
    corners.push(i, i + 1, i + columns, i + 1, i + columns + 1, i + columns);
  }
  return { id: filled(points), corners: filled(new Uint32Array(corners), gl.ELEMENT_ARRAY_BUFFER), count: corners.length };
}

const scene = gl && {
  obstacles: solid(data.obstacles),
  links: data.links.map(solid),
  energy: data.energy && relief(data.energy),
  floor: strip([0, 1, 2, 3].map((i) => [corner(i)[0], corner(i)[1], floor])),
  bounds: strip((planar ? [[0, 1], [1, 3], [3, 2], [2, 0]]
    : [[0, 1], [1, 3], [3, 2], [2, 0], [4, 5], [5, 7], [7, 6], [6, 4], [0, 4], [1, 5], [2, 6], [3, 7]])
    .flat().map((i) => planar ? [corner(i)[0], corner(i)[1], floor] : corner(i))),
};

const INK = [0.2, 0.22, 0.25], WAY = [0.62, 0.12, 0.25], STONE = [0.55, 0.59, 0.64];
const AMBER = [0.94, 0.65, 0.24], WINE = [0.75, 0.2, 0.34], TEAL = [0.10, 0.55, 0.52];

function drawFloor() {
  if (!scene.energy) draw(scene.floor, gl.TRIANGLE_STRIP, [0.93, 0.92, 0.88, 1]);
  draw(scene.bounds, gl.LINES, [0.75, 0.73, 0.68, 1]);
}

function drawEnergy(camera) {
  if (!scene.energy) return;
  const { made, at } = programs.relief;
  gl.useProgram(made);
  gl.uniformMatrix4fv(at.camera, false, camera);
  gl.uniform1f(at.step_, data.energy.step);
  gl.uniform1f(at.lowest, data.energy.lowest);
  gl.uniform1f(at.highest, data.energy.highest);
  gl.uniform3f(at.low, 0.47, 0.62, 0.62);
  gl.uniform3f(at.high, 0.925, 0.914, 0.87);
  attributes(scene.energy.id, 16, [[0, 3, 0], [1, 1, 12]]);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, scene.energy.corners);
  gl.drawElements(gl.TRIANGLES, scene.energy.count, gl.UNSIGNED_INT, 0);
}

// What is seen through: far faces first, then near ones.
function drawObstacles() {
  if (!element("show-obstacles").checked) return;
  gl.depthMask(planar);
  gl.enable(gl.CULL_FACE);
  for (const side of [gl.FRONT, gl.BACK]) {
    gl.cullFace(side);
    draw(scene.obstacles.faces, gl.TRIANGLES, [...STONE, planar ? 0.92 : 0.26]);
  }
  gl.disable(gl.CULL_FACE);
  draw(scene.obstacles.lines, gl.LINES, [...INK, planar ? 0.8 : 0.55], IDENTITY, 0.0004);
  gl.depthMask(true);
}

// The robot with its links in these frames.
function drawRobot(models, tone, opacity) {
  models.forEach((model, link) => {
    draw(scene.links[link].faces, gl.TRIANGLES, [...tone, opacity], model);
    draw(scene.links[link].lines, gl.LINES, [...INK, opacity], model, 0.0004);
  });
}
