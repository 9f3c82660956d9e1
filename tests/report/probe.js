// Uses a report as a person would and returns what it saw. Evaluated in the page by browser_test.cpp.
(async () => {
  const byId = (id) => document.getElementById(id);
  const wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
  const drawn = () => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  const frame = () => Number(/frame (\d+)/.exec(byId("position").textContent)[1]);
  const choose = (id, value) => {
    byId(id).value = value;
    byId(id).dispatchEvent(new Event(byId(id).tagName === "SELECT" ? "change" : "input"));
  };
  const press = (element, key) => element.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  const result = {};

  // The picture of the bodies, taken in the turn in which it is drawn.
  const picture = async (frameNumber) => {
    choose("scrub", String(frameNumber));
    return new Promise((resolve) => requestAnimationFrame(() => resolve(byId("stage").firstChild.toDataURL())));
  };

  // Pixels of about this colour in a picture.
  const pixelsOf = (name, { data }) => {
    const style = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);
    const wanted = style.match(/[0-9a-f]{2}/gi).map((digits) => parseInt(digits, 16));
    let found = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] > 200 && wanted.every((value, k) => Math.abs(value - data[i + k]) < 12)) ++found;
    return found;
  };

  const pickedByClicks = () => {
    const stage = byId("stage");
    const box = stage.getBoundingClientRect();
    const joints = new Set();
    for (let y = 10; y < box.height; y += 14)
      for (let x = 10; x < box.width; x += 14) {
        const place = { clientX: box.left + x, clientY: box.top + y, bubbles: true };
        stage.dispatchEvent(new PointerEvent("pointerdown", place));
        stage.dispatchEvent(new PointerEvent("pointerup", place));
        joints.add(byId("joint").value);
      }
    return joints.size;
  };

  await wait(500);
  result.heading = byId("title").textContent;
  result.bold = document.querySelectorAll("b").length;
  result.verdict = byId("verdict").textContent;
  result.drawing = byId("stage").dataset.drawing;
  result.labels = [...document.querySelectorAll("#stage .label")].map((label) => label.textContent.trim());
  result.overflow = document.documentElement.scrollWidth - window.innerWidth;

  result.opening = frame();

  choose("scrub", "5");
  await drawn();
  result.sought = frame();
  byId("play").click();
  // However long a loaded machine takes to draw them.
  for (let i = 0; i < 1200 && Number(byId("stage").dataset.drawn) < 12; ++i) await wait(50);
  result.playing = byId("play").textContent;
  result.played = frame();
  result.drawnFrame = Number(byId("stage").dataset.drawn);
  byId("play").click();
  await wait(100);
  result.stopped = frame();
  await wait(300);
  result.stayed = frame();
  const before = await picture(10);
  result.pictureMoves = before !== await picture(50);
  result.pictureReturns = before === await picture(10);

  choose("joint", "7");
  await drawn();
  result.curveOf = byId("charts").dataset.joint;
  result.charts = byId("charts").querySelectorAll(".chart").length;
  // A copy: browsers complain of pictures that are read more than once.
  const pictureOf = (canvas) => {
    const copy = document.createElement("canvas");
    Object.assign(copy, { width: canvas.width, height: canvas.height });
    const pen = copy.getContext("2d", { willReadFrequently: true });
    pen.drawImage(canvas, 0, 0);
    return pen.getImageData(0, 0, copy.width, copy.height);
  };
  const chart = pictureOf(byId("charts").querySelector("canvas"));
  result.cleanPixels = pixelsOf("clean", chart);
  result.markPixels = pixelsOf("mark", chart);
  const faint = (name, { data }) => {
    const style = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);
    const [red, green, blue] = style.match(/[0-9a-f]{2}/gi).map((digits) => parseInt(digits, 16));
    let found = 0;
    for (let i = 0; i < data.length; i += 4)
      found += data[i + 3] > 40 && data[i + 3] < 90 && Math.abs(data[i] - red) + Math.abs(data[i + 1] - green) +
        Math.abs(data[i + 2] - blue) < 30;
    return found;
  };
  result.bandPixels = faint("clean", chart);
  result.legendsOverCharts = document.querySelectorAll(".chart .dygraph-legend").length;
  const filled = async (joint) => {
    choose("joint", joint);
    await drawn();
    return Number(pixelsOf("filled", pictureOf(byId("charts").querySelector("canvas"))) > 3);
  };
  result.filledPixels = [await filled("7"), await filled("2")];
  const highlighted = async (at) => {
    choose("scrub", String(at));
    for (let i = 0; i < 200 && byId("stage").dataset.drawn !== String(at); ++i) await wait(20);
    return Number(byId("stage").dataset.highlighted);
  };
  result.highlighted = [await highlighted(30), 10];
  result.highlightedWhereFilled = [await highlighted(36), 10];
  result.pickedByClicks = pickedByClicks();

  const map = byId("heat-map").getBoundingClientRect();
  byId("heat-map").dispatchEvent(new MouseEvent("click", {
    clientX: map.right - 1, clientY: map.top + 4.5 * 14, bubbles: true }));
  result.heatFrame = frame();
  result.heatJoint = byId("joint").value;
  choose("scrub", "25");
  result.gap = byId("heat-value").textContent;
  press(byId("heat-map"), "ArrowDown");
  press(byId("heat-map"), "ArrowRight");
  result.keyed = [frame(), Number(byId("joint").value)];
  document.querySelector("#worst-frames button").click();
  result.worst = frame();

  const heads = [...document.querySelectorAll("#tables th button")];
  const first = () => document.querySelector("#tables td").textContent;
  heads[1].click();
  result.least = first();
  heads[1].click();
  result.most = first();
  result.badSegments = document.querySelectorAll("#segments tr.bad").length;
  return result;
})()
