// Draws the bodies with three.js.
(function (report) {
  "use strict";

  const upright = () => new THREE.Vector3(0, 1, 0);

  // One clip's body: bones are cylinders, joints spheres; joints in a gap are not there.
  class Body {
    constructor(scene, take, clip, thickness) {
      Object.assign(this, { take, clip, thickness });
      this.group = new THREE.Group();
      this.highlight = clip.key === "clean" ? "filled" : "mark";
      this.materials = { clip: new THREE.MeshLambertMaterial(), highlight: new THREE.MeshLambertMaterial(),
                         ink: new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.35 }) };
      const sphere = new THREE.SphereBufferGeometry(1, 14, 10);
      const cylinder = new THREE.CylinderBufferGeometry(1, 1, 1, 10);
      this.bones = this.add(cylinder, this.materials.clip, take.bones.length);
      this.joints = this.add(sphere, this.materials.clip, take.points.length);
      this.highlights = this.add(sphere, this.materials.highlight, clip.key === "truth" ? 0 : take.points.length);
      this.picked = this.add(sphere, this.materials.ink, 1);
      scene.add(this.group);
    }

    add(geometry, material, count) {
      if (count === 0) return null;
      const mesh = new THREE.InstancedMesh(geometry, material, count);
      mesh.frustumCulled = false;  // the geometry alone says nothing about where its copies are
      this.group.add(mesh);
      return mesh;
    }

    ball(mesh, index, place, size) {
      const matrix = new THREE.Matrix4();
      if (place && size > 0) matrix.makeScale(size, size, size).setPosition(...place);
      else matrix.makeScale(0, 0, 0);
      mesh.setMatrixAt(index, matrix);
      mesh.instanceMatrix.needsUpdate = true;
    }

    stick(index, from, to) {
      const matrix = new THREE.Matrix4().makeScale(0, 0, 0);
      if (from && to) {
        const a = new THREE.Vector3(...from);
        const along = new THREE.Vector3(...to).sub(a);
        const length = along.length();
        if (length > 0) {
          const turn = new THREE.Quaternion().setFromUnitVectors(upright(), along.clone().divideScalar(length));
          matrix.compose(a.addScaledVector(along, 0.5), turn,
                         new THREE.Vector3(0.55 * this.thickness, length, 0.55 * this.thickness));
        }
      }
      this.bones.setMatrixAt(index, matrix);
      this.bones.instanceMatrix.needsUpdate = true;
    }

    place({ frame, joint: picked, up }) {
      const { take, clip, thickness } = this;
      const places = new Map(take.points.map((joint) => [joint, take.position(clip, frame, joint, up)]));
      this.highlighted = 0;
      const size = take.bones.length > 0 ? thickness : 1.6 * thickness;
      take.points.forEach((joint, index) => {
        this.ball(this.joints, index, places.get(joint), size);
        const isHighlighted = take.highlight(clip.key, frame, joint) !== null;
        if (this.highlights) this.ball(this.highlights, index, places.get(joint), isHighlighted ? 1.7 * size : 0);
        this.highlighted += isHighlighted && places.get(joint) ? 1 : 0;
      });
      take.bones.forEach(([parent, joint], index) => this.stick(index, places.get(parent), places.get(joint)));
      this.ball(this.picked, 0, places.get(picked) || null, 3 * size);
    }

    colour() {
      this.materials.clip.color.set(report.colour(this.clip.key));
      this.materials.highlight.color.set(report.colour(this.highlight));
      this.materials.ink.color.set(report.colour("ink"));
    }
  }

  report.SceneView = class {
    constructor(take, view) {
      Object.assign(this, { view, name: "webgl" });
      this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
      this.renderer.autoClear = false;
      this.canvas = this.renderer.domElement;
      this.scene = new THREE.Scene();
      this.scene.add(new THREE.HemisphereLight(0xffffff, 0x777777, 0.95));
      const sun = new THREE.DirectionalLight(0xffffff, 0.35);
      sun.position.set(1, 2, 1.5);
      this.scene.add(sun);
      this.cell = view.body.radius / 2;
      this.floor = new THREE.GridHelper(16 * this.cell, 16);
      this.floor.material = new THREE.LineBasicMaterial();
      this.scene.add(this.floor);
      this.bodies = take.clips.map((clip) => new Body(this.scene, take, clip, view.body.radius / 42));
    }

    resize(width, height, ratio) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
    }

    draw(panels) {
      const { view, renderer } = this;
      const { target } = view.controls;
      this.floor.material.color.set(report.colour("line"));
      this.floor.position.set(Math.round(target.x / this.cell) * this.cell, view.body.floor,
                              Math.round(target.z / this.cell) * this.cell);
      for (const body of this.bodies) {
        body.colour();
        body.place(view.state.values);
      }
      this.highlighted = 0;
      for (const panel of panels)
        for (const body of this.bodies) if (panel.clips.includes(body.clip)) this.highlighted += body.highlighted;
      renderer.setScissorTest(false);
      renderer.clear();
      renderer.setScissorTest(true);
      for (const panel of panels) {
        for (const body of this.bodies) body.group.visible = panel.clips.includes(body.clip);
        view.aim(panel);
        renderer.setViewport(panel.left, 0, panel.width, view.height);
        renderer.setScissor(panel.left, 0, panel.width, view.height);
        renderer.render(this.scene, view.camera);
      }
    }
  };
})(window.mocleanReport);
