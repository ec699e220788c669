// The bodies of an arm in light and shade: three.js, loaded only when a figure comes near.
//
// Arrows, letters and lines are drawn over it by the stage, which also says from where it is seen.

import {
  AmbientLight, Color, CylinderGeometry, DirectionalLight, Mesh, MeshStandardMaterial, OrthographicCamera, Scene,
  SphereGeometry, BoxGeometry, Vector3, WebGLRenderer,
} from "three";

const UP = new Vector3(0, 1, 0);
const SHAPES = {
  tube: new CylinderGeometry(1, 1, 1, 28, 1),
  ball: new SphereGeometry(1, 24, 16),
  block: new BoxGeometry(2, 1, 2),
};

globalThis.DhSpace = class {
  constructor(canvas) {
    const context = canvas.getContext("webgl2", { antialias: true, alpha: true, stencil: false });
    if (!context) throw new Error("no WebGL"); // three.js would complain aloud
    this.renderer = new WebGLRenderer({ canvas, context });
    this.scene = new Scene();
    this.camera = new OrthographicCamera();
    this.sun = new DirectionalLight(0xffffff, 2.2);
    this.scene.add(this.sun, this.sun.target, new AmbientLight(0xffffff, 1.5));
    this.materials = {};
    this.meshes = [];
  }

  /** Take the colours of the page, by name: one, another, and how much of the other there is in it. */
  paint(colours) {
    for (const [name, [value, other, part]] of Object.entries(colours)) {
      this.materials[name] ??= new MeshStandardMaterial({ roughness: 0.65, metalness: 0.05 });
      this.materials[name].color = new Color(value).lerp(new Color(other), part);
    }
  }

  /** Show bodies, each with its shape, two ends, radius and colour, from where the stage is seen. */
  show(stage, bodies) {
    const { width, height, camera: { x, y, zoom } } = stage;
    if (this.size !== `${width} ${height}`) {
      this.size = `${width} ${height}`;
      this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
      this.renderer.setSize(width, height, false);
    }
    bodies.forEach((body, k) => this.#place(k, body));
    this.meshes.forEach((mesh, k) => { mesh.visible = k < bodies.length; });

    const far = 100 * (width + height) / zoom;
    const [right, down, toward] = [stage.right, stage.down, stage.toward].map((v) => new Vector3(...v));
    const centre = right.clone().multiplyScalar(x).addScaledVector(down, y);
    this.camera.position.copy(centre).addScaledVector(toward, far / 2);
    this.camera.up.copy(down).negate();
    this.camera.lookAt(centre);
    Object.assign(this.camera, { left: -width / 2 / zoom, right: width / 2 / zoom, top: height / 2 / zoom, bottom: -height / 2 / zoom, near: 0, far });
    this.camera.updateProjectionMatrix();
    this.sun.position.copy(toward).addScaledVector(right, -0.5).addScaledVector(down, -0.9);
    this.renderer.render(this.scene, this.camera);
  }

  #place(k, { shape, start, end, radius, colour }) {
    if (!this.meshes[k]) this.scene.add((this.meshes[k] = new Mesh()));
    const mesh = this.meshes[k];
    const [one, other] = [new Vector3(...start), new Vector3(...end)];
    const way = other.clone().sub(one);
    mesh.geometry = SHAPES[shape];
    mesh.material = this.materials[colour];
    mesh.position.copy(one).addScaledVector(way, 0.5);
    mesh.scale.set(radius, shape === "ball" ? radius : way.length(), radius);
    if (shape !== "ball") mesh.quaternion.setFromUnitVectors(UP, way.normalize());
  }
};
