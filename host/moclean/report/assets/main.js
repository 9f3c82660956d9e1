// Puts the page together.
(function (report) {
  "use strict";

  const { byId } = report;

  function showTake(take) {
    for (const section of document.querySelectorAll("[data-take]")) section.hidden = false;
    const state = new report.State({
      frame: 0, frames: take.frames, joint: 0, playing: false, speed: 1, up: "y", follow: true,
      apart: window.innerWidth > 520, shown: take.clips.map((clip) => clip.key),
    });
    const worst = report.showHeadline(take, state);
    const begin = take.figures.opening;
    state.set({ joint: begin ? begin.joint : worst, frame: begin ? begin.frame : 0 });
    report.showPlayer(take, state);
    report.showCurves(take, state);
    report.showHeatMap(take, state);
    report.showSegments(take, state);
    const rate = take.rate > 0 ? `${report.number(take.rate)} frames/s` : "frame rate unknown";
    byId("subtitle").textContent =
      `${take.frames} frames, ${take.joints.length} joints, ${take.columns} columns, ${rate}`;
  }

  const element = byId("data");
  const data = JSON.parse(element.textContent);
  element.remove();
  byId("title").textContent = data.title;
  if (data.take) showTake(new report.Take(data.take));
  report.showTables(data.tables);
  report.showParameters(data.parameters);
})(window.mocleanReport);
