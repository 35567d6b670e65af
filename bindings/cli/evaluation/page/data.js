// The report's data as the page uses it: decoded surfaces and one list of all cases.

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// Little-endian, whatever the machine is.
function integersOf(base64, size) {
  const bytes = bytesOf(base64);
  const view = new DataView(bytes.buffer);
  const count = bytes.length / size;
  const numbers = new Uint32Array(count);
  for (let i = 0; i < count; ++i) numbers[i] = size === 2 ? view.getUint16(2 * i, true) : view.getUint32(4 * i, true);
  return numbers;
}

// Area-weighted normals of the vertices.
function normalsOf(positions, triangles) {
  const normals = new Float32Array(positions.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const u = [0, 1, 2].map((k) => positions[b + k] - positions[a + k]);
    const v = [0, 1, 2].map((k) => positions[c + k] - positions[a + k]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (const at of [a, b, c]) for (let k = 0; k < 3; ++k) normals[at + k] += n[k];
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[i + k] /= length;
  }
  return normals;
}

// Positions are brought to the page's units: centred, the longest side 2.
function surfaceOf(shown) {
  const steps = integersOf(shown.positions, 2);
  const low = shown.low, size = shown.size;
  const centre = [0, 1, 2].map((k) => low[k] + shown.extent[k] / 2);
  const toPage = (p) => p.map((x, k) => (2 * (x - centre[k])) / size);
  const positions = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; ++i) {
    const k = i % 3;
    positions[i] = (2 * (low[k] + (size * steps[i]) / 65535 - centre[k])) / size;
  }
  const triangles = integersOf(shown.triangles, shown.index_bytes);
  return { positions, triangles, normals: normalsOf(positions, triangles), toPage };
}

function once(make) {
  let made;
  return () => (made ??= make());
}

function prepare(data) {
  for (const mesh of data.meshes) {
    mesh.surface = once(() => surfaceOf(mesh.shown));
    mesh.votesOf = (name) => {
      const packed = mesh.shown.votes[name];
      return packed === undefined ? null : bytesOf(packed);
    };
    const errors = Object.values(mesh.errors_edges).map(numberOr(Infinity));
    mesh.mean = errors.length ? errors.reduce((a, b) => a + b, 0) / errors.length : NaN;
    mesh.worst = errors.length ? Math.max(...errors) : NaN;
    mesh.worstName = Object.keys(mesh.errors_edges)[errors.indexOf(mesh.worst)] ?? null;
  }
  data.names = data.landmarks.map((row) => row.name);
  data.cases = data.meshes.flatMap((mesh, index) =>
    Object.entries(mesh.errors_edges).map(([name, error]) => ({ index, name, error: error ?? Infinity })));
  data.cases.sort((a, b) => b.error - a.error || a.index - b.index);
  return data;
}

// JSON has no infinity: an error without any place to measure from is null.
function numberOr(other) {
  return (x) => (x === null || x === undefined ? other : x);
}

function text(x, digits = 2) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (!Number.isFinite(x)) return "no place";
  return x.toFixed(digits);
}

function percent(x, digits = 0) {
  return x === null || x === undefined || Number.isNaN(x) ? "–" : `${(100 * x).toFixed(digits)} %`;
}

function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(properties)) {
    if (value === null || value === undefined) continue;
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (key === "class") made.className = value;
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}
