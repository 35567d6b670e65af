// The page's own renderer, for where three.js or WebGL is missing: triangles from back to front (painter's algorithm;
// Newell, Newell, Sancha 1972) on a plain canvas.

const keyLight = unit([-0.45, 0.75, 0.65]), fillLight = unit([0.8, 0.1, 0.4]);

function unit(v) {
  const length = Math.hypot(...v) || 1;
  return v.map((x) => x / length);
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function turned(turn, x, y, z) {
  return turn.map((row) => row[0] * x + row[1] * y + row[2] * z);
}

function shadeOf(normal) {
  return 0.42 + 0.52 * Math.max(0, dot(normal, keyLight)) + 0.12 * Math.max(0, dot(normal, fillLight));
}

// Triangles that face the viewer, the farthest first.
function visibleTriangles(surface, placed, depths) {
  const t = surface.triangles;
  const order = [];
  for (let i = 0; i < t.length; i += 3) {
    const [a, b, c] = [2 * t[i], 2 * t[i + 1], 2 * t[i + 2]];
    const area = (placed[b] - placed[a]) * (placed[c + 1] - placed[a + 1]) -
      (placed[c] - placed[a]) * (placed[b + 1] - placed[a + 1]);
    if (area < 0) order.push(i); // y points down on the screen
  }
  const depth = (i) => depths[t[i]] + depths[t[i + 1]] + depths[t[i + 2]];
  return order.sort((a, b) => depth(a) - depth(b));
}

function createFlatRenderer() {
  return {
    name: "canvas",
    draw(context, surface, colours, { turn, scale, centre }) {
      const count = surface.positions.length / 3;
      const placed = new Float32Array(2 * count), depths = new Float32Array(count), shades = new Float32Array(count);
      for (let v = 0; v < count; ++v) {
        const p = surface.positions.subarray(3 * v, 3 * v + 3), n = surface.normals.subarray(3 * v, 3 * v + 3);
        const [x, y, z] = turned(turn, p[0], p[1], p[2]);
        placed[2 * v] = centre[0] + scale * x;
        placed[2 * v + 1] = centre[1] - scale * y;
        depths[v] = z;
        shades[v] = shadeOf(turned(turn, n[0], n[1], n[2]));
      }
      context.lineWidth = 0.7;
      context.lineJoin = "round";
      const t = surface.triangles;
      for (const i of visibleTriangles(surface, placed, depths)) {
        const corners = [t[i], t[i + 1], t[i + 2]];
        const shade = (shades[t[i]] + shades[t[i + 1]] + shades[t[i + 2]]) / 3;
        const channel = (k) => Math.round(85 * shade * corners.reduce((sum, v) => sum + colours[3 * v + k], 0));
        context.fillStyle = context.strokeStyle = `rgb(${channel(0)},${channel(1)},${channel(2)})`;
        context.beginPath();
        for (const v of corners) context.lineTo(placed[2 * v], placed[2 * v + 1]);
        context.closePath();
        context.fill();
        context.stroke(); // closes the hairline gaps between neighbours
      }
    },
  };
}

function createRenderer() {
  const wanted = location.hash === "#flat" ? "flat" : "three"; // a page can be asked for its own renderer
  if (wanted === "three" && typeof FocalThree !== "undefined") {
    try {
      return FocalThree.createSurfaceRenderer();
    } catch {
      // no WebGL here
    }
  }
  return createFlatRenderer();
}
