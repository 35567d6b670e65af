// How a mesh is looked at, and one picture of it: surface, vote map, marks.

const rampStops = [[0.80, 0.78, 0.74], [0.98, 0.86, 0.55], [0.97, 0.60, 0.25], [0.85, 0.22, 0.16], [0.50, 0.04, 0.16]];

function rampAt(value) {
  const place = Math.min(Math.max(value, 0), 1) * (rampStops.length - 1);
  const below = Math.min(Math.floor(place), rampStops.length - 2);
  return rampStops[below].map((x, k) => x + (place - below) * (rampStops[below + 1][k] - x));
}

// Colours of the vertices: one hue without votes, else the ramp.
function coloursOf(surface, votes) {
  const colours = new Float32Array(surface.positions.length);
  for (let v = 0; v < colours.length / 3; ++v) colours.set(rampAt(votes ? votes[v] / 255 : 0), 3 * v);
  return colours;
}

function product(a, b) {
  return a.map((row) => [0, 1, 2].map((k) => row[0] * b[0][k] + row[1] * b[1][k] + row[2] * b[2][k]));
}

function aboutY(angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [[c, 0, s], [0, 1, 0], [-s, 0, c]];
}

function aboutX(angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [[1, 0, 0], [0, c, -s], [0, s, c]];
}

// What brings the mesh's own up direction to the page's +Y.
const uprights = {
  Y: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  Z: [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
  X: [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
};

function turnOf(yaw, pitch, up) {
  return product(aboutX(pitch), product(aboutY(yaw), uprights[up]));
}

function nearestVertex(surface, point) {
  let best = 0, bestDistance = Infinity;
  for (let i = 0; i < surface.positions.length; i += 3) {
    const distance = Math.hypot(surface.positions[i] - point[0], surface.positions[i + 1] - point[1],
      surface.positions[i + 2] - point[2]);
    if (distance < bestDistance) [best, bestDistance] = [i, distance];
  }
  return best;
}

// The turn from which marks can be seen: their normals point at the viewer, a little from above.
function turnTowards(surface, points, up) {
  const normal = [0, 0, 0];
  for (const point of points) {
    const vertex = nearestVertex(surface, point);
    for (let k = 0; k < 3; ++k) normal[k] += surface.normals[vertex + k];
  }
  const [x, y, z] = turned(uprights[up], ...normal);
  const level = Math.hypot(x, z);
  const yaw = level > 0.15 ? -Math.atan2(x, z) : 0.4;
  const pitch = Math.max(-0.5, Math.min(1.2, Math.atan2(y, level) * 0.6));
  return turnOf(yaw, pitch + 0.1, up);
}

// The bounds of the turned surface, so that it fills its picture whatever its shape.
function fitted(surface, turn, width, height, zoom = 1, margin = 0.07) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (let i = 0; i < surface.positions.length; i += 3) {
    const place = turned(turn, ...surface.positions.subarray(i, i + 3));
    for (let k = 0; k < 2; ++k) {
      low[k] = Math.min(low[k], place[k]);
      high[k] = Math.max(high[k], place[k]);
    }
  }
  const room = 1 - 2 * margin;
  const scale = zoom * Math.min(room * width / (high[0] - low[0] || 1), room * height / (high[1] - low[1] || 1));
  const middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  return { turn, scale, centre: [width / 2 - scale * middle[0], height / 2 + scale * middle[1]] };
}

// Whether a triangle lies clearly nearer to the viewer than the point.
function isHidden(surface, view, point) {
  const [px, py, pz] = turned(view.turn, ...point);
  const t = surface.triangles, p = surface.positions;
  const corner = (v) => turned(view.turn, p[3 * v], p[3 * v + 1], p[3 * v + 2]);
  for (let i = 0; i < t.length; i += 3) {
    const a = corner(t[i]), b = corner(t[i + 1]), c = corner(t[i + 2]);
    const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if (area <= 0) continue;
    const u = ((b[0] - px) * (c[1] - py) - (c[0] - px) * (b[1] - py)) / area;
    const v = ((c[0] - px) * (a[1] - py) - (a[0] - px) * (c[1] - py)) / area;
    if (u < 0 || v < 0 || u + v > 1) continue;
    if (u * a[2] + v * b[2] + (1 - u - v) * c[2] > pz + 0.03) return true;
  }
  return false;
}

function placeOf(view, point) {
  const [x, y, z] = turned(view.turn, ...point);
  return [view.centre[0] + view.scale * x, view.centre[1] - view.scale * y, z];
}

// What is to be drawn over the surface for one landmark: where it is marked, found, and the second choice.
function marksOf(mesh, name, withSecond) {
  const toPage = mesh.surface().toPage, found = mesh.found[name], marks = [];
  const mark = mesh.marks[name] ? toPage(mesh.marks[name]) : null;
  const guess = found?.position ? toPage(found.position) : null;
  if (withSecond && found?.second) marks.push({ kind: "second", at: toPage(found.second), name });
  if (mark) marks.push({ kind: "mark", at: mark, name });
  if (guess) marks.push({ kind: "guess", at: guess, name, to: mark });
  return marks;
}

const markColours = { mark: "#12a150", guess: "#2563eb", second: "#8b5cf6" };

function disc(context, x, y, radius, fill, ratio) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = fill;
  context.fill();
  context.lineWidth = 1.6 * ratio;
  context.strokeStyle = "#fff";
  context.stroke();
}

function drawMark(context, surface, view, mark, ratio, size) {
  const [x, y] = placeOf(view, mark.at);
  context.globalAlpha = isHidden(surface, view, mark.at) ? 0.35 : 1;
  if (mark.to) {
    const [mx, my] = placeOf(view, mark.to);
    for (const [colour, width] of [["#fff", 4], [markColours.guess, 2]]) {
      context.strokeStyle = colour;
      context.lineWidth = width * ratio;
      context.beginPath();
      context.moveTo(mx, my);
      context.lineTo(x, y);
      context.stroke();
    }
  }
  if (mark.kind === "mark") { // a ring, so that the found one can be seen within
    disc(context, x, y, size * 1.45 * ratio, markColours.mark, ratio);
  } else if (mark.kind === "second") {
    disc(context, x, y, size * 0.8 * ratio, markColours.second, ratio);
  } else {
    disc(context, x, y, size * 0.9 * ratio, markColours.guess, ratio);
  }
  context.globalAlpha = 1;
  return [x, y];
}

function drawNames(context, places, ratio, dark) {
  context.font = `${12 * ratio}px system-ui, sans-serif`;
  context.lineWidth = 3 * ratio;
  context.lineJoin = "round";
  for (const [name, x, y] of places) {
    context.strokeStyle = dark ? "#1f2125" : "#fffdf9";
    context.fillStyle = dark ? "#e8e6e1" : "#24262b";
    context.strokeText(name, x + 9 * ratio, y + 4 * ratio);
    context.fillText(name, x + 9 * ratio, y + 4 * ratio);
  }
}

// One picture on a canvas of its own. options: turn, zoom, name (of a landmark or null: all), votes, marks, names.
function drawPicture(renderer, canvas, mesh, options) {
  const ratio = window.devicePixelRatio || 1;
  const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
  const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  const context = canvas.getContext("2d"), surface = mesh.surface();
  context.clearRect(0, 0, width, height);
  const view = fitted(surface, options.turn, width, height, options.zoom);
  const votes = options.votes && options.name ? mesh.votesOf(options.name) : null;
  renderer.draw(context, surface, coloursOf(surface, votes), view);
  if (!options.marks) return;
  const names = options.name ? [options.name] : Object.keys(mesh.found);
  const marks = names.flatMap((name) => marksOf(mesh, name, options.name !== null));
  const depth = (mark) => turned(view.turn, ...mark.at)[2] + (mark.kind === "guess" ? 0.02 : 0);
  marks.sort((a, b) => depth(a) - depth(b));
  const size = (options.name ? 6 : 4.2) * Math.min(1, 0.35 + canvas.clientHeight / 700), places = [];
  for (const mark of marks) {
    const [x, y] = drawMark(context, surface, view, mark, ratio, size);
    if (mark.kind === "guess" || (mark.kind === "mark" && !mesh.found[mark.name]?.position)) {
      places.push([mark.name, x, y]);
    }
  }
  if (options.names) drawNames(context, places, ratio, matchMedia("(prefers-color-scheme: dark)").matches);
}
