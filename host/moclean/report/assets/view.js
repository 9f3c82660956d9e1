// One camera for all bodies: turning, zooming, following, panels side by side, picking. What draws
// the panels is a SceneView (WebGL) or a FlatView (plain canvas); see webglWorks().
(function (report) {
  "use strict";

  const fieldOfView = 30;
  const pickDistance = 18;  // pixels

  function webglWorks() {
    const canvas = document.createElement("canvas");
    try {
      return Boolean(canvas.getContext("webgl2") || canvas.getContext("webgl"));
    } catch (error) {
      return false;
    }
  }

  // Where a body is, how far it reaches and where it stands, over frames of the whole take.
  function measure(take, clip, up) {
    let radius = 0;
    let floor = Infinity;
    const step = Math.max(1, Math.floor(take.frames / 50));
    for (let frame = 0; frame < take.frames; frame += step) {
      const places = take.points.map((joint) => take.position(clip, frame, joint, up)).filter(Boolean);
      const middle = mean(places);
      for (const place of places) {
        radius = Math.max(radius, Math.hypot(...place.map((x, axis) => x - middle[axis])));
        floor = Math.min(floor, place[1]);
      }
    }
    return { radius: radius || 1, floor: Number.isFinite(floor) ? floor : 0 };
  }

  function mean(places) {
    const sum = [0, 0, 0];
    for (const place of places) for (let axis = 0; axis < 3; ++axis) sum[axis] += place[axis] / places.length;
    return sum;
  }

  report.View = class {
    constructor(stage, take, state) {
      Object.assign(this, { stage, take, state });
      this.camera = new THREE.PerspectiveCamera(fieldOfView, 1, 0.1, 1000);
      this.leader = take.clip("truth") || take.clip("clean");  // whom the camera follows
      this.body = measure(take, this.leader, state.values.up);
      this.drawing = webglWorks() ? new report.SceneView(take, this) : new report.FlatView(take, this);
      stage.append(this.drawing.canvas);
      stage.dataset.drawing = this.drawing.name;
      this.labels = report.element("div");
      stage.append(this.labels);
      this.controls = new THREE.OrbitControls(this.camera, stage);
      this.controls.enableKeys = false;
      this.controls.enableZoom = false;  // the wheel scrolls the page until the stage has the focus
      this.controls.screenSpacePanning = true;
      this.controls.addEventListener("change", () => this.request());
      stage.addEventListener("focus", () => { this.controls.enableZoom = true; });
      stage.addEventListener("blur", () => { this.controls.enableZoom = false; });
      stage.addEventListener("touchstart", () => stage.focus({ preventScroll: true }), { passive: true });
      this.pickOnClick();
      this.resize();
      this.reset();
      new ResizeObserver(() => { this.resize(); this.request(); }).observe(stage);
      report.onThemeChange(() => this.request());
    }

    reset() {
      const { up, frame } = this.state.values;
      this.body = measure(this.take, this.leader, up);
      const { radius } = this.body;
      this.camera.near = radius / 50;
      this.camera.far = radius * 100;
      // A body is about half as wide as it is high.
      const narrow = Math.min(1, 1.6 * this.panels()[0].width / this.height);
      const distance = 0.9 * radius / Math.sin(fieldOfView * Math.PI / 360) / narrow;
      const target = this.middle(frame) || new THREE.Vector3();
      this.controls.target.copy(target);
      this.camera.position.set(0.55, 0.22, 0.8).normalize().multiplyScalar(distance).add(target);
      this.controls.update();
      this.request();
    }

    middle(frame) {
      const { up } = this.state.values;
      const places = this.take.points.map((joint) => this.take.position(this.leader, frame, joint, up)).filter(Boolean);
      return places.length > 0 ? new THREE.Vector3(...mean(places)) : null;
    }

    follow(frame) {
      const target = this.middle(frame);
      if (target === null) return;
      this.camera.position.add(target.clone().sub(this.controls.target));
      this.controls.target.copy(target);
      this.camera.lookAt(target);
    }

    resize() {
      this.width = Math.max(1, this.stage.clientWidth);
      this.height = Math.max(1, this.stage.clientHeight);
      this.drawing.resize(this.width, this.height, Math.min(2, window.devicePixelRatio || 1));
      this.label();
    }

    // Parts of the stage, from left to right, with the clips each shows.
    panels() {
      const { shown, apart } = this.state.values;
      const clips = this.take.clips.filter((clip) => shown.includes(clip.key));
      const groups = apart ? clips.map((clip) => [clip]) : [clips];
      const width = this.width / Math.max(1, groups.length);
      return (groups.length > 0 ? groups : [[]]).map((group, i) => ({ clips: group, left: i * width, width }));
    }

    label() {
      this.labels.replaceChildren();
      for (const panel of this.panels()) {
        const label = report.element("div", { class: "label" });
        label.style.left = `${panel.left}px`;
        for (const clip of panel.clips)
          label.append(report.element("span", { class: clip.key }, clip.label), " ");
        this.labels.append(label);
      }
    }

    aim(panel) {
      this.camera.aspect = panel.width / this.height;
      this.camera.updateProjectionMatrix();
      this.camera.updateMatrixWorld();
    }

    // Pixels from the stage's corner, or null behind the camera. The camera has to aim at the panel.
    project(place, panel) {
      const point = new THREE.Vector3(...place).applyMatrix4(this.camera.matrixWorldInverse);
      if (point.z > -this.camera.near) return null;
      point.applyMatrix4(this.camera.projectionMatrix);
      return [panel.left + (point.x + 1) / 2 * panel.width, (1 - point.y) / 2 * this.height];
    }

    pickOnClick() {
      let begin = null;
      this.stage.addEventListener("pointerdown", (event) => { begin = [event.clientX, event.clientY]; });
      this.stage.addEventListener("pointerup", (event) => {
        if (begin === null || Math.hypot(event.clientX - begin[0], event.clientY - begin[1]) > 4) return;
        const box = this.stage.getBoundingClientRect();
        const joint = this.jointAt(event.clientX - box.left, event.clientY - box.top);
        if (joint !== null) this.state.set({ joint });
      });
    }

    jointAt(x, y) {
      const panel = this.panels().find((part) => x >= part.left && x < part.left + part.width);
      if (!panel) return null;
      this.aim(panel);
      let nearest = pickDistance;
      let found = null;
      for (const clip of panel.clips)
        for (const joint of this.take.points) {
          const place = this.take.position(clip, this.state.values.frame, joint, this.state.values.up);
          const pixel = place && this.project(place, panel);
          const distance = pixel ? Math.hypot(pixel[0] - x, pixel[1] - y) : Infinity;
          if (distance < nearest) {
            nearest = distance;
            found = joint;
          }
        }
      return found;
    }

    // Turns by angles (radians) or zooms by a factor, for the keyboard.
    turn(around, above, factor) {
      const offset = this.camera.position.clone().sub(this.controls.target);
      const sphere = new THREE.Spherical().setFromVector3(offset);
      sphere.theta += around;
      sphere.phi += above;
      sphere.radius *= factor;
      sphere.makeSafe();
      this.camera.position.copy(offset.setFromSpherical(sphere)).add(this.controls.target);
      this.controls.update();
      this.request();
    }

    // Draws once before the next picture of the page, however often it is asked for.
    request() {
      if (this.requested) return;
      this.requested = true;
      requestAnimationFrame(() => {
        this.requested = false;
        this.drawing.draw(this.panels());
        this.stage.dataset.drawn = String(this.state.values.frame);
        this.stage.dataset.highlighted = String(this.drawing.highlighted);
      });
    }
  };
})(window.mocleanReport);
