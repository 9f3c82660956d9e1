// Frames from left to right, joints from top to bottom; a click goes to both.
(function (report) {
  "use strict";

  const { byId, element, number } = report;
  const rowHeight = 14;
  const axisHeight = 18;

  // Dark means bad on light ground, bright means bad on dark ground.
  const scales = {
    light: [[255, 255, 255], [254, 217, 142], [240, 120, 40], [150, 20, 30], [60, 0, 30]],
    dark: [[24, 29, 33], [74, 34, 74], [180, 55, 70], [248, 150, 60], [255, 245, 190]],
  };

  function shade(share) {
    const scale = report.isDark() ? scales.dark : scales.light;
    const at = Math.max(0, Math.min(1, share)) * (scale.length - 1);
    const low = Math.min(scale.length - 2, Math.floor(at));
    return scale[low].map((from, i) => Math.round(from + (at - low) * (scale[low + 1][i] - from)));
  }

  function kindsOf(take) {
    const kinds = [{ label: "what was taken away, |E|",
                     value: (frame, joint) => take.corrections.value(frame, joint) }];
    const truth = take.clip("truth");
    if (truth)
      for (const [key, label] of [["noisy", "error before, |noisy − truth|"],
                                  ["clean", "error left, |clean − truth|"]])
        kinds.push({ label, value: (frame, joint) => take.distance(take.clip(key), truth, frame, joint) });
    return kinds;
  }

  class HeatMap {
    constructor(box, take, state) {
      Object.assign(this, { box, take, state, kinds: kindsOf(take) });
      this.canvas = element("canvas");
      box.append(this.canvas);
      this.choose(0);
      new ResizeObserver(() => this.paint()).observe(box);
      report.onThemeChange(() => this.paint());
      box.addEventListener("click", (event) => {
        const [frame, joint] = this.at(event);
        if (joint !== null) state.seek(frame, { joint });
      });
      box.addEventListener("mousemove", (event) => this.tell(...this.at(event)));
      box.addEventListener("keydown", (event) => this.key(event));
    }

    choose(index) {
      const { take } = this;
      this.values = new Float32Array(take.frames * take.joints.length);
      for (let f = 0, i = 0; f < take.frames; ++f)
        for (let j = 0; j < take.joints.length; ++j) this.values[i++] = this.kinds[index].value(f, j);
      const sorted = this.values.filter((value) => value > 0).sort();
      // One wild entry would leave all others pale: what exceeds 99.5 % of them is one colour.
      this.largest = sorted.length > 0 ? sorted[Math.floor(0.995 * (sorted.length - 1))] : 1;
      if (this.picture) this.paint();
    }

    // Paints all but the cursor; a pixel shows the worst of its frames.
    paint() {
      const { take, canvas, box } = this;
      const ratio = Math.min(2, window.devicePixelRatio || 1);
      const names = Math.max(...take.joints.map((joint) => joint.name.length));
      this.left = Math.min(Math.round(6.6 * names + 8), Math.round(box.clientWidth * 0.28));
      this.width = Math.max(1, box.clientWidth - this.left);
      this.height = take.joints.length * rowHeight;
      canvas.width = Math.round(box.clientWidth * ratio);
      canvas.height = Math.round((this.height + axisHeight) * ratio);
      canvas.style.height = `${this.height + axisHeight}px`;
      const pen = canvas.getContext("2d");
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      pen.imageSmoothingEnabled = false;
      pen.drawImage(this.cells(Math.min(take.frames, Math.round(this.width * ratio))), this.left, 0, this.width,
                    this.height);
      this.names(pen);
      this.axis(pen);
      this.picture = element("canvas", { width: canvas.width, height: canvas.height });
      this.picture.getContext("2d").drawImage(canvas, 0, 0);
      this.ratio = ratio;
      this.cursor();
      this.legend(ratio);
    }

    cells(columns) {
      const { take, values } = this;
      const cells = element("canvas", { width: columns, height: take.joints.length });
      const pen = cells.getContext("2d");
      const image = pen.createImageData(columns, take.joints.length);
      const [gap, filled] = ["gap", "filled"].map((name) =>
        report.colour(name).match(/[0-9a-f]{2}/gi).map((digits) => parseInt(digits, 16)));
      for (let j = 0, i = 0; j < take.joints.length; ++j)
        for (let c = 0; c < columns; ++c, i += 4) {
          const last = Math.max(1, Math.floor((c + 1) * take.frames / columns));
          let worst = NaN;
          for (let f = Math.floor(c * take.frames / columns); f < last; ++f) {
            const value = values[f * take.joints.length + j];
            if (!(worst >= value) && !Number.isNaN(value)) worst = value;
          }
          const without = take.isJointFilled(last - 1, j) ? filled : gap;
          image.data.set(Number.isNaN(worst) ? without : shade(worst / this.largest), i);
          image.data[i + 3] = 255;
        }
      pen.putImageData(image, 0, 0);
      return cells;
    }

    names(pen) {
      pen.font = "11px system-ui, sans-serif";
      pen.textBaseline = "middle";
      pen.fillStyle = report.colour("faint");
      this.take.joints.forEach((joint, j) => pen.fillText(joint.name, 0, (j + 0.5) * rowHeight, this.left - 4));
    }

    axis(pen) {
      const { take } = this;
      const rough = take.frames / Math.max(2, this.width / 110);
      const unit = 10 ** Math.floor(Math.log10(Math.max(1, rough)));
      const step = [1, 2, 5, 10].map((factor) => factor * unit).find((size) => size >= rough) || 10 * unit;
      for (let frame = 0; frame < take.frames; frame += step)
        pen.fillText(String(frame), this.x(frame), this.height + axisHeight / 2 + 1);
    }

    x(frame) { return this.left + frame / this.take.frames * this.width; }

    cursor() {
      const { canvas, state } = this;
      const { frame, joint } = state.values;
      const pen = canvas.getContext("2d");
      pen.clearRect(0, 0, canvas.width, canvas.height);
      pen.drawImage(this.picture, 0, 0, canvas.width / this.ratio, canvas.height / this.ratio);
      pen.strokeStyle = report.colour("accent");
      pen.lineWidth = 1.5;
      pen.strokeRect(this.left + 1, joint * rowHeight + 0.5, this.width - 2, rowHeight - 1);
      pen.beginPath();
      pen.moveTo(this.x(frame + 0.5), 0);
      pen.lineTo(this.x(frame + 0.5), this.height);
      pen.stroke();
      this.tell(frame, joint);
    }

    legend(ratio) {
      const canvas = byId("heat-legend");
      const [width, height] = [220, 26];
      canvas.width = width * ratio;
      canvas.height = height * ratio;
      const pen = canvas.getContext("2d");
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      for (let x = 0; x < width; ++x) {
        pen.fillStyle = `rgb(${shade(x / width).join(",")})`;
        pen.fillRect(x, 0, 1, 10);
      }
      pen.font = "11px system-ui, sans-serif";
      pen.textBaseline = "bottom";
      pen.fillStyle = report.colour("faint");
      pen.fillText("0", 0, height);
      pen.textAlign = "right";
      pen.fillText(`${number(this.largest)} and more`, width, height);
    }

    // Frame and joint below the pointer; the joint is null beside the rows.
    at(event) {
      const place = this.canvas.getBoundingClientRect();
      const share = (event.clientX - place.left - this.left) / this.width;
      const frame = Math.max(0, Math.min(this.take.frames - 1, Math.floor(share * this.take.frames)));
      const joint = Math.floor((event.clientY - place.top) / rowHeight);
      return [frame, joint >= 0 && joint < this.take.joints.length ? joint : null];
    }

    tell(frame, joint) {
      if (joint === null) return;
      const value = this.values[frame * this.take.joints.length + joint];
      byId("heat-value").textContent = `frame ${frame}, ${this.take.joints[joint].name}: ` +
        (Number.isNaN(value) ? (this.take.isJointFilled(frame, joint) ? "filled" : "gap") : number(value));
    }

    key(event) {
      const { frame, joint } = this.state.values;
      const size = event.shiftKey ? Math.max(1, Math.round(this.take.frames / 50)) : 1;
      const moves = { ArrowLeft: [-size, 0], ArrowRight: [size, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
      if (!moves[event.key]) return;
      event.preventDefault();
      const [frames, rows] = moves[event.key];
      const last = this.take.joints.length - 1;
      this.state.seek(frame + frames, { joint: Math.max(0, Math.min(last, joint + rows)) });
    }
  }

  report.showHeatMap = (take, state) => {
    const map = new HeatMap(byId("heat-map"), take, state);
    map.paint();
    const choice = byId("heat-kind");
    map.kinds.forEach((kind, index) => choice.append(element("option", { value: index }, kind.label)));
    choice.addEventListener("change", () => map.choose(Number(choice.value)));
    state.listen((values, changed) => { if (changed.frame || changed.joint) map.cursor(); });
  };
})(window.mocleanReport);
