// Triangles with normals, smooth where faces meet flatly, and the edges where they do not.
const FLAT = 0.8;
function solid(bodies) {
  const faces = [], lines = [];
  for (const { v, t } of bodies) {
    const at = (i) => [v[3 * i], v[3 * i + 1], v[3 * i + 2]];
    const normals = [], around = new Map(), edges = new Map(), count = v.length / 3;
    const note = (map, key, face) => { const all = map.get(key); if (all) all.push(face); else map.set(key, [face]); };
    for (let f = 0; f < t.length; f += 3) {
      const [a, b, c] = [t[f], t[f + 1], t[f + 2]];
      normals.push(unit(cross(sub(at(b), at(a)), sub(at(c), at(a)))));
      for (const [from, to] of [[a, b], [b, c], [c, a]]) {
        note(around, from, f / 3);
        note(edges, Math.min(from, to) * count + Math.max(from, to), f / 3);
      }
    }
    t.forEach((i, corner) => {
      const own = normals[Math.floor(corner / 3)], sum = [0, 0, 0];
      for (const f of around.get(i)) if (dot(own, normals[f]) > FLAT)
        normals[f].forEach((x, axis) => { sum[axis] += x; });
      faces.push(...at(i), ...unit(sum));
    });
    for (const [key, met] of edges)
      if (met.length !== 2 || dot(normals[met[0]], normals[met[1]]) < FLAT)
        for (const i of [Math.floor(key / count), key % count]) lines.push(...at(i), 0, 0, 0);
  }
  return { faces: buffer(faces), lines: buffer(lines) };
}
