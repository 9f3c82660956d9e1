// The controls below the stage, the keys, and time.
(function (report) {
  "use strict";

  const { byId, element } = report;
  const assumedRate = 120;  // Hz, where the file states none

  // Moves the frame while playing; begins again at the end.
  function run(take, state) {
    const rate = take.rate || assumedRate;
    let last = null;  // time of the last step
    let at = 0;       // frame with its fraction
    const step = (now) => {
      const { playing, speed, frame, frames } = state.values;
      if (!playing) return;
      if (Math.floor(at) !== frame) at = frame;  // somebody else has moved it
      const seconds = last === null ? 0 : Math.min(0.25, (now - last) / 1000);
      at = (at + seconds * rate * speed) % frames;
      last = now;
      state.set({ frame: Math.floor(at) });
      requestAnimationFrame(step);
    };
    state.listen((values, changed) => {
      if (!changed.playing || !values.playing) return;
      at = values.frame;
      last = null;
      requestAnimationFrame(step);
    });
  }

  function showChoices(take, state) {
    for (const clip of take.clips) {
      const box = element("input", { type: "checkbox" });
      box.checked = true;
      box.addEventListener("change", () => {
        const shown = state.values.shown.filter((key) => key !== clip.key);
        state.set({ shown: box.checked ? [...shown, clip.key] : shown });
      });
      byId("shown").append(element("label", { class: clip.key }, box, ` ${clip.key}`));
    }
  }

  function connect(state) {
    byId("play").addEventListener("click", () => state.set({ playing: !state.values.playing }));
    byId("scrub").addEventListener("input", (event) => state.seek(Number(event.target.value)));
    byId("speed").addEventListener("change", (event) => state.set({ speed: Number(event.target.value) }));
    byId("apart").checked = state.values.apart;
    for (const name of ["apart", "follow"])
      byId(name).addEventListener("change", (event) => state.set({ [name]: event.target.checked }));
    byId("up").addEventListener("change", (event) => state.set({ up: event.target.value }));
  }

  // Keys of the stage.
  function keys(view, state) {
    const angle = Math.PI / 24;
    const actions = {
      ArrowLeft: () => view.turn(-angle, 0, 1),
      ArrowRight: () => view.turn(angle, 0, 1),
      ArrowUp: () => view.turn(0, -angle, 1),
      ArrowDown: () => view.turn(0, angle, 1),
      "+": () => view.turn(0, 0, 0.9),
      "=": () => view.turn(0, 0, 0.9),
      "-": () => view.turn(0, 0, 1.1),
      " ": () => state.set({ playing: !state.values.playing }),
      ",": () => state.seek(state.values.frame - 1),
      ".": () => state.seek(state.values.frame + 1),
    };
    view.stage.addEventListener("keydown", (event) => {
      const action = actions[event.key];
      if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      action();
    });
  }

  function showPosition(take, values) {
    byId("play").textContent = values.playing ? "Pause" : "Play";
    byId("scrub").value = String(values.frame);
    const rate = take.rate > 0 ? take.time(values.frame) : `rate unknown, played at ${assumedRate}/s`;
    byId("position").textContent = `frame ${values.frame} of ${values.frames}, ${rate}`;
  }

  report.showPlayer = (take, state) => {
    byId("scrub").max = String(take.frames - 1);
    showChoices(take, state);
    connect(state);
    run(take, state);
    showPosition(take, state.values);
    const view = take.points.length > 0 ? new report.View(byId("stage"), take, state) : null;
    byId("stage").hidden = view === null;
    if (view) {
      keys(view, state);
      byId("reset-view").addEventListener("click", () => view.reset());
    } else {
      for (const bar of byId("player").querySelectorAll(".options, .hint")) bar.hidden = true;
    }
    state.listen((values, changed) => {
      if (changed.frame || changed.playing) showPosition(take, values);
      if (!view) return;
      if (changed.up) view.reset();
      if (changed.shown || changed.apart) view.label();
      if ((changed.frame || changed.follow) && values.follow) view.follow(values.frame);
      if (!(changed.playing && Object.keys(changed).length === 1)) view.request();
    });
  };
})(window.mocleanReport);
