// Opens a report in headless Chromium as its readers do: on a desk, on a phone, in the dark, printed, by keyboard.
//   node report_browser.mjs NPM_FOLDER CHROMIUM PAGE REFERENCE [--update]
// REFERENCE holds the pictures' mean colours on a coarse grid, so that a page that is blank, broken or drawn otherwise
// shows, and another font does not. Prints a line for each complaint; exit status 1 if there are any.
import { createRequire } from "node:module";
import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [npm, chromium, file, reference, update] = process.argv.slice(2);
const require = createRequire(`${npm}/package.json`);
const { chromium: driver } = require("playwright-core");

const complaints = [];
const complain = (text) => complaints.push(text);
const GRID = 8;
const TOLERANCE = 14; // of 255, a mean colour of a cell

async function open(browser, options) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  page.on("console", (message) => complain(`console: ${message.text()}`));
  page.on("pageerror", (error) => complain(`script: ${error}`));
  await context.route("**/*", (route) => {
    const url = route.request().url();
    if (url.startsWith("file:") && url.includes(encodeURI(file.split("/").pop()))) return route.continue();
    if (url.startsWith("data:")) return route.continue();
    complain(`asks for ${url}`);
    return route.abort();
  });
  await page.goto(pathToFileURL(file).href);
  return { context, page };
}

// Mean colours of a screenshot's cells, decoded by the browser itself.
async function cells(page, png) {
  return page.evaluate(async ({ data, grid }) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = image.width;
    canvas.height = image.height;
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    const out = [];
    for (let row = 0; row < grid; ++row) {
      for (let column = 0; column < grid; ++column) {
        const x = Math.floor((column * image.width) / grid), y = Math.floor((row * image.height) / grid);
        const w = Math.max(1, Math.floor(image.width / grid)), h = Math.max(1, Math.floor(image.height / grid));
        const pixels = context.getImageData(x, y, w, h).data;
        const sum = [0, 0, 0];
        for (let i = 0; i < pixels.length; i += 4) for (let k = 0; k < 3; ++k) sum[k] += pixels[i + k];
        out.push(sum.map((s) => Math.round((s * 4) / pixels.length)));
      }
    }
    return out;
  }, { data: png.toString("base64"), grid: GRID });
}

async function checkLayout(page, where, smallestFont = 12) {
  const found = await page.evaluate((smallest) => ({
    wide: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    broken: [...document.images].filter((i) => !(i.complete && i.naturalWidth > 0)).length,
    images: document.images.length,
    noAlt: [...document.images].filter((i) => !i.alt).length,
    headings: document.querySelectorAll("h1").length,
    lang: document.documentElement.lang,
    small: [...document.querySelectorAll("p, td, th, figcaption, li")].filter((e) => parseFloat(getComputedStyle(e).fontSize) < smallest).length,
    nameless: [...document.querySelectorAll("a, input, summary, [role=region]")].filter((e) =>
      !(e.textContent.trim() || e.getAttribute("aria-label"))).length,
    anchors: [...document.querySelectorAll('a[href^="#"]')].filter((a) => !document.querySelector(a.getAttribute("href"))).length,
    plotText: Math.min(...[...document.querySelectorAll("svg.plot text")].map((e) => e.getBoundingClientRect().height)),
    plots: [...document.querySelectorAll("svg.plot")].map((s) => [s.querySelectorAll("circle").length, s.getBoundingClientRect().width]),
  }), smallestFont);
  if (found.wide > 0) complain(`${where}: the page is ${found.wide} pixels too wide`);
  if (found.images < 5 || found.broken > 0) complain(`${where}: ${found.broken} of ${found.images} pictures are broken`);
  if (found.noAlt + found.nameless + found.small + found.anchors > 0 || found.headings !== 1 || found.lang !== "en") {
    complain(`${where}: not accessible: ${JSON.stringify(found)}`);
  }
  if (found.plotText < 9) complain(`${where}: the plots' text is ${found.plotText} pixels high`);
  if (found.plots.length !== 3 || found.plots.some(([dots, width]) => dots < 2 || width < 200)) {
    complain(`${where}: plots ${JSON.stringify(found.plots)}`);
  }
}

async function checkPictures(page, where) {
  const stored = update ? {} : JSON.parse(readFileSync(reference, "utf8"));
  const pictures = {};
  for (const image of await page.locator("img").all()) {
    await image.scrollIntoViewIfNeeded();
    pictures[await image.getAttribute("alt")] = await cells(page, await image.screenshot());
  }
  if (update) {
    writeFileSync(reference, `${JSON.stringify(pictures).replaceAll('],"', '],\n"')}\n`);
    return;
  }
  if (Object.keys(pictures).join() !== Object.keys(stored).join()) complain(`${where}: other pictures: ${Object.keys(pictures)}`);
  for (const [name, grid] of Object.entries(pictures)) {
    const far = Math.max(...grid.flat().map((value, i) => Math.abs(value - (stored[name] ?? grid).flat()[i])));
    if (far > TOLERANCE) complain(`${where}: picture '${name}' differs by ${far} of 255`);
  }
}

// Tab reaches everything there is to use, in order, and Space enlarges a picture and lets it go.
async function checkKeyboard(page) {
  const wanted = await page.locator("a, input, summary, [tabindex]").evaluateAll((all) => all.filter((e) => e.checkVisibility()).length);
  const reached = new Set();
  for (let i = 0; i < wanted + 2; ++i) {
    await page.keyboard.press("Tab");
    const at = await page.evaluate(() => {
      const e = document.activeElement;
      if (!e || e === document.body) return "";
      const ring = getComputedStyle(e.matches("input") ? e.nextElementSibling : e);
      return `${[...document.querySelectorAll("*")].indexOf(e)} ${ring.outlineStyle !== "none"}`;
    });
    if (at.endsWith("false")) complain(`keyboard: no ring around ${at}`);
    if (at) reached.add(at);
  }
  if (reached.size < wanted) complain(`keyboard: Tab reaches ${reached.size} of ${wanted}`);
  const box = page.locator(".zoom input").first();
  const width = () => box.evaluate((e) => e.nextElementSibling.getBoundingClientRect().width);
  const before = await width();
  await box.focus();
  await page.keyboard.press("Space");
  if (!((await width()) > 1.5 * before)) complain("keyboard: Space enlarges nothing");
  await page.keyboard.press("Space");
  if (Math.abs((await width()) - before) > 1) complain("keyboard: an enlarged picture stays");
}

// Some machines let no program make a sandbox; one that starts no browser at all says nothing about the page.
async function start() {
  const plain = ["--disable-gpu", "--disable-dev-shm-usage"];
  const tries = process.getuid() === 0 ? [["--no-sandbox"]] : [[], ["--no-sandbox"]];
  let reason = "";
  for (const more of tries) {
    try {
      return await driver.launch({ executablePath: chromium, args: [...plain, ...more], timeout: 60000 });
    } catch (error) {
      reason = String(error).split("\n")[0];
    }
  }
  console.log(`NOT RUN: Chromium does not start: ${reason}`);
  process.exit(77);
}

const browser = await start();
try {
  const desk = await open(browser, { viewport: { width: 1280, height: 900 } });
  await checkLayout(desk.page, "desk");
  await checkPictures(desk.page, "desk");
  await checkKeyboard(desk.page);
  await desk.context.close();

  const phone = await open(browser, { viewport: { width: 360, height: 740 }, deviceScaleFactor: 2, isMobile: true });
  await checkLayout(phone.page, "phone");
  await phone.context.close();

  const dark = await open(browser, { viewport: { width: 1280, height: 900 }, colorScheme: "dark" });
  const shade = await dark.page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number));
  if (Math.max(...shade) > 60) complain(`dark: the paper is ${shade}`);
  await dark.context.close();

  const paper = await open(browser, { viewport: { width: 800, height: 1100 } });
  await paper.page.emulateMedia({ media: "print" });
  await checkLayout(paper.page, "print", 10);
  if (await paper.page.locator("nav").isVisible()) complain("print: links to click are printed");
  if ((await paper.page.pdf()).length < 20000) complain("print: the PDF is empty");
  await paper.context.close();
} finally {
  await browser.close();
}
for (const line of complaints) console.log(line);
process.exit(complaints.length > 0 ? 1 : 0);
