// WebGL: programs, buffers, and how they are drawn.
const element = (id) => document.getElementById(id);
const canvas = element("view");
const gl = canvas.getContext("webgl2", { antialias: true });

function program(vertex, fragment, names) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const at = {};
  for (const name of names) at[name] = gl.getUniformLocation(made, name);
  return { made, at };
}

const LIT = `
    in vec3 n, p; in vec4 tint; uniform vec3 eye, light; out vec4 pixel;
    void main() {
      float shade = 1.0;
      if (dot(n, n) > 0.0) {
        vec3 m = normalize(n), toward = normalize(eye - p);
        if (dot(m, toward) < 0.0) m = -m;
        shade = 0.62 + 0.30 * max(dot(m, light), 0.0) + 0.14 * dot(m, toward);
      }
      pixel = vec4(tint.rgb * shade * tint.a, tint.a);
    }`;
const programs = gl && {
  // Surfaces and lines of one colour in one frame.
  plain: program(`
    layout(location = 0) in vec3 point; layout(location = 1) in vec3 normal;
    uniform mat4 model, camera; uniform float nearer; uniform vec2 beside; uniform vec4 colour;
    out vec3 n, p; out vec4 tint;
    void main() {
      vec4 world = model * vec4(point, 1.0);
      n = mat3(model) * normal; p = world.xyz; tint = colour;
      gl_Position = camera * world; gl_Position.z -= nearer * gl_Position.w;
      gl_Position.xy += beside * gl_Position.w;
    }`, LIT, ["model", "camera", "nearer", "beside", "colour", "eye", "light"]),
  // Points and lines, each end with its own colour.
  graph: program(`
    layout(location = 0) in vec3 point; layout(location = 1) in vec4 colour;
    uniform mat4 camera; uniform float size, nearer; out vec4 tint;
    void main() {
      gl_Position = camera * vec4(point, 1.0); gl_Position.z -= nearer * gl_Position.w;
      gl_PointSize = size; tint = colour;
    }`, `
    in vec4 tint; uniform float opacity; uniform bool dots; out vec4 pixel;
    void main() {
      float a = opacity * tint.a;
      if (dots) {
        float r = length(gl_PointCoord - 0.5);
        if (r > 0.5) discard;
        a *= 1.0 - smoothstep(0.38, 0.5, r);
      }
      pixel = vec4(tint.rgb * a, a);
    }`, ["camera", "size", "nearer", "opacity", "dots"]),
  // One surface at many frames, made smaller about a point of each.
  crowd: program(`
    layout(location = 0) in vec3 point; layout(location = 1) in vec3 normal;
    layout(location = 2) in vec3 place; layout(location = 3) in vec4 turn;
    layout(location = 4) in vec3 about; layout(location = 5) in vec4 colour;
    uniform mat4 camera; uniform float smaller; out vec3 n, p; out vec4 tint;
    vec3 turned(vec3 v) { return v + 2.0 * cross(turn.yzw, cross(turn.yzw, v) + turn.x * v); }
    void main() {
      n = turned(normal); p = about + smaller * (place + turned(point) - about); tint = colour;
      gl_Position = camera * vec4(p, 1.0);
    }`, LIT, ["camera", "smaller", "eye", "light"]),
  // An energy over the plane: bands between contours, and the contours.
  relief: program(`
    layout(location = 0) in vec3 point; layout(location = 1) in float energy;
    uniform mat4 camera; out float e;
    void main() { e = energy; gl_Position = camera * vec4(point, 1.0); }`, `
    in float e; uniform float step_, lowest, highest; uniform vec3 low, high; out vec4 pixel;
    void main() {
      float level = e / step_, share = clamp((floor(level) * step_ - lowest + step_) / (highest - lowest + step_), 0.0, 1.0);
      float from_line = abs(level - round(level)) / max(fwidth(level), 1e-9);
      float line = e > highest + 0.5 * step_ ? 0.0 : 1.0 - smoothstep(0.4, 1.2, from_line);
      vec3 band = e > highest ? vec3(0.945, 0.937, 0.91) : mix(low, high, share);
      pixel = vec4(mix(band, vec3(0.2, 0.22, 0.25), 0.38 * line), 1.0);
    }`, ["camera", "step_", "lowest", "highest", "low", "high"]),
};

// A buffer of the card with these numbers.
function filled(numbers, kind = gl.ARRAY_BUFFER) {
  const id = gl.createBuffer();
  gl.bindBuffer(kind, id);
  gl.bufferData(kind, numbers, gl.STATIC_DRAW);
  return id;
}
// Points with normals, six numbers each.
const buffer = (numbers) => ({ id: filled(new Float32Array(numbers)), count: numbers.length / 6 });
const strip = (points) => buffer(points.flatMap((p) => [...p, 0, 0, 0]));

// Attributes of a buffer: at which location, how many numbers, at which byte, and for how many instances each.
function attributes(id, stride, list) {
  gl.bindBuffer(gl.ARRAY_BUFFER, id);
  for (const [location, size, offset, per = 0, kind = gl.FLOAT] of list) {
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, kind, kind === gl.UNSIGNED_BYTE, stride, offset);
    gl.vertexAttribDivisor(location, per);
  }
}
function noAttributes(first, end) {
  for (let i = first; i < end; i++) { gl.vertexAttribDivisor(i, 0); gl.disableVertexAttribArray(i); }
}

function draw(what, mode, colour, model = IDENTITY, nearer = 0) {
  const { at } = programs.plain;
  attributes(what.id, 24, [[0, 3, 0], [1, 3, 12]]);
  gl.uniformMatrix4fv(at.model, false, model);
  gl.uniform1f(at.nearer, nearer);
  gl.uniform4f(at.colour, ...colour);
  gl.drawArrays(mode, 0, what.count);
}
// Lines of WebGL are one pixel wide: a wider one is drawn several times, each time a little beside.
function drawWide(what, mode, colour) {
  const { at } = programs.plain, by = pixels();
  for (const [x, y] of [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]]) {
    gl.uniform2f(at.beside, 2 * x * by / canvas.width, 2 * y * by / canvas.height);
    draw(what, mode, colour);
  }
  gl.uniform2f(at.beside, 0, 0);
}
// Pixels of the screen to one of the page.
const pixels = () => window.devicePixelRatio || 1;
