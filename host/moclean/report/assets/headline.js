// The first thing a user sees: whether the take got better, and where it was bad.
(function (report) {
  "use strict";

  const { element, number, byId } = report;

  function pair(values) {
    return [element("span", { class: "noisy" }, number(values[0])), " → ",
            element("span", { class: "clean" }, number(values[1]))];
  }

  function figure(name, value, note) {
    const body = element("dd", {}, ...[].concat(value));
    if (note) body.append(element("small", {}, note));
    byId("figures").append(element("div", {}, element("dt", {}, name), body));
  }

  function showFigures(take) {
    const all = take.figures;
    const unit = take.unit ? ` ${take.unit}` : "";
    const percent = `${(100 * all.corrected / Math.max(1, all.observed)).toFixed(1)} %`;
    if (all.fd) figure("FD from the truth", pair(all.fd), `before → after,${unit || " unit of the file"}`);
    figure("Entries corrected", percent, all.threshold > 0 ? `by more than ${number(all.threshold)}` : "");
    if (all.filled + all.left > 0) figure("Entries filled", String(all.filled), `${all.left} left missing`);
    figure("Frames corrected", `${all.correctedFrames} of ${take.frames}`);
    if (all.fd) {
      figure("Joints nearer to the truth", `${all.nearerJoints} of ${take.joints.length}`);
      figure("Frames nearer to the truth", `${all.nearerFrames} of ${take.frames}`,
             `${take.frames - all.nearerFrames} are farther or as before`);
    }
    figure("Roughness", pair(all.roughness), "second difference, RMS");
  }

  function bars(noisy, clean, largest) {
    const box = element("span", { class: "bars" });
    const add = (value, colour) => {
      const bar = element("i");
      bar.style.width = `${largest > 0 ? 100 * value / largest : 0}%`;
      bar.style.background = `var(--${colour})`;
      box.append(bar);
    };
    add(noisy, clean === null ? "mark" : "noisy");
    if (clean !== null) add(clean, "clean");
    return box;
  }

  // One line: a name, its bars, its numbers; a click leads there.
  function line(list, name, before, after, largest, go) {
    const numbers = element("span", { class: "numbers" },
                            ...(after === null ? [number(before)] : pair([before, after])));
    const button = element("button", { type: "button" }, element("span", { class: "name", title: name }, name),
                           bars(before, after, largest), numbers);
    button.addEventListener("click", go);
    list.append(element("li", {}, button));
  }

  function showWorstJoints(take, state) {
    const all = take.figures.joints.map((joint, index) => ({
      index, before: joint.error ? joint.error[0] : joint.correction, after: joint.error ? joint.error[1] : null,
    }));
    const badness = (joint) => Math.max(joint.before, joint.after);  // cleaning can spoil a good one
    all.sort((a, b) => badness(b) - badness(a));
    for (const joint of all.slice(0, 5))
      line(byId("worst-joints"), take.joints[joint.index].name, joint.before, joint.after, badness(all[0]),
           () => state.set({ joint: joint.index }));
    return all[0].index;
  }

  function showWorstFrames(take, state) {
    const hasTruth = take.figures.fd !== null;
    const of = (frame) => hasTruth ? [take.perFrame.value(frame, 1), take.perFrame.value(frame, 2)]
                                   : [take.perFrame.value(frame, 0), null];
    const worst = take.figures.worstFrames;
    const largest = worst.length > 0 ? Math.max(...of(worst[0].frame)) : 0;
    for (const { frame, joint } of worst)
      line(byId("worst-frames"), `${frame}, ${take.joints[joint].name}`, ...of(frame), largest,
           () => state.seek(frame, { joint }));
    if (worst.length === 0) byId("worst-frames").append(element("li", {}, "none"));
  }

  function showOverview(take, state) {
    const hasTruth = take.figures.fd !== null;
    byId("overview-title").textContent = hasTruth
      ? "Error of each frame before and after (RMS difference from the truth)"
      : "What was taken away from each frame (RMS of E)";
    const rows = [];
    for (let f = 0; f < take.frames; ++f)
      rows.push(hasTruth ? [f, take.perFrame.value(f, 1), take.perFrame.value(f, 2)]
                         : [f, take.perFrame.value(f, 0)]);
    const drawing = { fillGraph: true };
    const series = hasTruth ? { noisy: { colour: "noisy", drawing }, clean: { colour: "clean", drawing } }
                            : { corrected: { colour: "mark", drawing } };
    report.createChart(byId("overview"), rows, series, state, { includeZero: true, fillAlpha: 0.3 });
  }

  // Returns the joint to begin with: the worst.
  report.showHeadline = (take, state) => {
    const verdict = byId("verdict");
    const [first, ...rest] = take.verdict.split(". ");  // what follows the first sentence is a remark
    verdict.append(rest.length > 0 ? `${first}.` : first, element("small", {}, rest.join(". ")));
    if (take.figures.fd)
      verdict.className = take.figures.fd[1] < take.figures.fd[0] ? "better" : "worse";
    const hasTruth = take.figures.fd !== null;
    const kind = hasTruth ? "RMS error, before → after" : "RMS correction";
    byId("worst-joints-title").textContent = `Worst joints (${kind})`;
    byId("worst-frames-title").textContent = `Worst frames (${kind})`;
    showFigures(take);
    const joint = showWorstJoints(take, state);
    showWorstFrames(take, state);
    showOverview(take, state);
    return joint;
  };
})(window.mocleanReport);
