// Draws the bodies on a plain canvas, for browsers without WebGL.
(function (report) {
  "use strict";

  report.FlatView = class {
    constructor(take, view) {
      Object.assign(this, { take, view, name: "canvas" });
      this.canvas = document.createElement("canvas");
    }

    resize(width, height, ratio) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
      this.pen = this.canvas.getContext("2d");
      this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    }

    draw(panels) {
      const { pen, view } = this;
      pen.clearRect(0, 0, view.width, view.height);
      this.highlighted = 0;
      for (const panel of panels) {
        pen.save();
        pen.beginPath();
        pen.rect(panel.left, 0, panel.width, view.height);
        pen.clip();
        view.aim(panel);
        this.floor(panel);
        for (const clip of panel.clips) this.body(clip, panel);
        pen.restore();
      }
    }

    line(from, to, panel) {
      const a = this.view.project(from, panel);
      const b = this.view.project(to, panel);
      if (!a || !b) return;
      this.pen.beginPath();
      this.pen.moveTo(...a);
      this.pen.lineTo(...b);
      this.pen.stroke();
    }

    floor(panel) {
      const { radius, floor } = this.view.body;
      const cell = radius / 2;
      const { x, z } = this.view.controls.target;
      const column = Math.round(x / cell);
      const row = Math.round(z / cell);
      this.pen.strokeStyle = report.colour("line");
      this.pen.lineWidth = 1;
      for (let i = -8; i <= 8; ++i)
        for (let k = -8; k < 8; ++k) {
          this.line([(column + i) * cell, floor, (row + k) * cell],
                    [(column + i) * cell, floor, (row + k + 1) * cell], panel);
          this.line([(column + k) * cell, floor, (row + i) * cell],
                    [(column + k + 1) * cell, floor, (row + i) * cell], panel);
        }
    }

    dot(pixel, size, colour) {
      this.pen.beginPath();
      this.pen.arc(...pixel, size, 0, 2 * Math.PI);
      this.pen.fillStyle = colour;
      this.pen.fill();
    }

    body(clip, panel) {
      const { pen, take, view } = this;
      const { frame, joint: picked, up } = view.state.values;
      const places = new Map(take.points.map((joint) => [joint, take.position(clip, frame, joint, up)]));
      const colour = report.colour(clip.key);
      pen.strokeStyle = colour;
      pen.lineWidth = 3;
      pen.lineCap = "round";
      for (const [parent, joint] of take.bones)
        if (places.get(parent) && places.get(joint)) this.line(places.get(parent), places.get(joint), panel);
      for (const [joint, place] of places) {
        const pixel = place && view.project(place, panel);
        if (!pixel) continue;
        const highlight = take.highlight(clip.key, frame, joint);
        this.dot(pixel, highlight ? 5 : 3, highlight ? report.colour(highlight) : colour);
        this.highlighted += highlight ? 1 : 0;
        if (joint !== picked) continue;
        pen.beginPath();
        pen.arc(...pixel, 9, 0, 2 * Math.PI);
        pen.strokeStyle = report.colour("ink");
        pen.lineWidth = 2;
        pen.stroke();
        pen.strokeStyle = colour;
      }
    }
  };
})(window.mocleanReport);
