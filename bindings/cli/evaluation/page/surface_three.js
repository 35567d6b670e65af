// Draws a surface with three.js. Bundled by bundle.sh into one script that leaves FocalThree behind; the page does
// without it when it is not there or when the browser has no WebGL.
import {
  BufferAttribute, BufferGeometry, Color, DirectionalLight, HemisphereLight, Mesh, MeshStandardMaterial,
  OrthographicCamera, Scene, WebGLRenderer,
} from "three";

// One WebGL context for all pictures of a page, since browsers allow but a few: each is drawn here, then copied.
export function createSurfaceRenderer() {
  const renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(1); // callers count in the pixels of the screen
  const scene = new Scene();
  const camera = new OrthographicCamera();
  camera.position.z = 4;
  scene.add(new HemisphereLight(0xffffff, 0x6d6558, 1.5));
  const key = new DirectionalLight(0xfff6e8, 2.1);
  key.position.set(-0.45, 0.75, 0.65);
  scene.add(key);
  const fill = new DirectionalLight(0xdfe8ff, 0.5);
  fill.position.set(0.8, 0.1, 0.4);
  scene.add(fill);
  const body = new Mesh(new BufferGeometry(),
    new MeshStandardMaterial({ vertexColors: true, roughness: 0.82, metalness: 0 }));
  body.matrixAutoUpdate = false;
  body.frustumCulled = false;
  scene.add(body);
  const known = new WeakMap();

  function geometryOf(surface) {
    if (!known.has(surface)) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(surface.positions, 3));
      geometry.setAttribute("normal", new BufferAttribute(surface.normals, 3));
      geometry.setAttribute("color", new BufferAttribute(new Float32Array(surface.positions.length), 3));
      geometry.setIndex(new BufferAttribute(surface.triangles, 1));
      known.set(surface, geometry);
    }
    return known.get(surface);
  }

  function paint(geometry, colours) { // colours: sRGB 0..1, three floats a vertex
    const attribute = geometry.getAttribute("color");
    const colour = new Color();
    for (let v = 0; v < attribute.count; ++v) {
      colour.setRGB(colours[3 * v], colours[3 * v + 1], colours[3 * v + 2], "srgb");
      attribute.setXYZ(v, colour.r, colour.g, colour.b);
    }
    attribute.needsUpdate = true;
  }

  return {
    name: "three.js",
    // turn: rows of a 3 x 3 rotation; scale: pixels of one unit; the surface's centre lands on centre.
    draw(context, surface, colours, { turn, scale, centre }) {
      const { width, height } = context.canvas;
      renderer.setSize(width, height, false);
      const geometry = geometryOf(surface);
      paint(geometry, colours);
      body.geometry = geometry;
      const [a, b, c] = turn;
      body.matrix.set(...a, 0, ...b, 0, ...c, 0, 0, 0, 0, 1);
      camera.left = -centre[0] / scale;
      camera.right = (width - centre[0]) / scale;
      camera.top = centre[1] / scale;
      camera.bottom = (centre[1] - height) / scale;
      camera.updateProjectionMatrix();
      renderer.render(scene, camera);
      context.drawImage(renderer.domElement, 0, 0);
    },
  };
}
