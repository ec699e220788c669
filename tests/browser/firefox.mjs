// Drive the site in Firefox, over WebDriver BiDi, and report as JSON on standard output.
// Arguments: the Firefox to start, and where the site is. Each visit opens a page, uses it, and says what it saw.
import puppeteer from "puppeteer-core";

const [executablePath, site] = process.argv.slice(2);
const browser = await puppeteer.launch({
  browser: "firefox",
  executablePath,
  headless: true,
  extraPrefsFirefox: { "ui.prefersReducedMotion": 1, "webgl.force-enabled": true },
});

/** Run in the page: draw, then wait for the picture. */
const drawn = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done()))));
const pressed = async (page, find, ...keys) => {
  const handle = await page.evaluateHandle(find);
  await handle.asElement().evaluate((element) => { element.scrollIntoView({ block: "center" }); element.focus(); });
  for (const key of keys) await page.keyboard.press(key);
  await drawn(page);
};
const seen = (page) => page.evaluate(() => {
  const figure = document.querySelector("dh-link, dh-robot, dh-place");
  const inner = figure.shadowRoot;
  return {
    sentence: inner.querySelector(".sentence").textContent,
    matrix: [...inner.querySelectorAll(".matrix tbody td:not(.corner)")].map((cell) => cell.textContent).filter(Boolean),
    state: figure.state ?? figure.joints ?? figure.placed,
    broken: [...inner.querySelectorAll("svg *")].filter((e) => /NaN|undefined|Infinity/.test(e.outerHTML)).length,
    arrows: inner.querySelectorAll("svg .arrow").length,
    height: figure.getBoundingClientRect().height,
  };
});
/** A figure is laid out when a reader comes near it. */
const comeTo = async (page) => {
  await page.$eval("dh-link, dh-robot, dh-place", (figure) => figure.scrollIntoView());
  await page.waitForFunction('document.querySelector("dh-link, dh-robot, dh-place").shadowRoot.querySelector("svg .arrow")');
};
const ranges = (k) => `document.querySelector("dh-link, dh-robot, dh-place").shadowRoot.querySelectorAll("input[type=range]")[${k}]`;

const VISITS = {
  "book/index.html": async (page) => ({ heading: await page.$eval("main h1", (h) => h.textContent) }),
  "book/cheatsheet.html": async (page) => ({ formulas: await page.$$eval("main .math svg", (all) => all.filter((one) => one.getBoundingClientRect().width > 0).length) }),
  "exercises/quickshot.html": async (page) => ({ heading: await page.$eval("main h1", (h) => h.textContent) }),
  "search.html?q=twist": async (page) => {
    await page.waitForSelector("#search-results li a");
    return { found: (await page.$$("#search-results li a")).length };
  },
  "book/classic.html": async (page) => {
    await comeTo(page);
    const first = await seen(page);
    await pressed(page, ranges(0), "End");
    const turned = await seen(page);
    await pressed(page, 'document.querySelector("dh-link").shadowRoot.querySelector("[aria-label=\'One step on\']")', "Enter");
    const step = await seen(page);
    const form = await page.$("form.dh-question");
    await form.evaluate((one) => one.scrollIntoView({ block: "center" }));
    await form.waitForSelector("input"); // which come when the reader comes near
    await form.evaluate((one) => {
      const entry = one.querySelector("input");
      if (entry.type === "text") one.querySelectorAll("input").forEach((input) => { input.value = "12345.678"; });
      else entry.checked = true;
      one.querySelector("button").focus();
    });
    await page.keyboard.press("Enter");
    await page.waitForSelector("form.dh-question:is([data-state=right], [data-state=wrong])");
    return { first, turned, step, verdict: await form.$eval("output", (output) => output.textContent) };
  },
  "book/pa10.html": async (page) => {
    await page.$eval("dh-robot", (figure) => figure.scrollIntoView());
    await page.waitForFunction('document.querySelector("dh-robot").space || !document.querySelector("dh-robot").canvas.isConnected');
    await drawn(page);
    const first = await seen(page);
    await pressed(page, ranges(7), "End");
    const round = await seen(page);
    await pressed(page, ranges(3), "Home");
    return { first, round, moved: await seen(page), webgl: await page.evaluate('Boolean(document.querySelector("dh-robot").space)') };
  },
  "book/placing.html": async (page) => {
    await comeTo(page);
    const first = await seen(page);
    await pressed(page, ranges(0), "ArrowRight", "ArrowRight");
    const slid = await seen(page);
    await pressed(page, 'document.querySelector("dh-place").shadowRoot.querySelector("[aria-pressed]")', "Enter");
    return { first, slid, over: await seen(page) };
  },
};

const report = {};
try {
  for (const [name, visit] of Object.entries(VISITS)) {
    if (site.startsWith("file:") && name.startsWith("search")) continue;
    const page = await browser.newPage();
    await page.setViewport({ width: 1200, height: 800 });
    const complaints = [];
    page.on("console", (said) => { if (said.type() === "error") complaints.push(said.text()); });
    page.on("pageerror", (error) => complaints.push(String(error)));
    await page.goto(`${site}/${name}`, { waitUntil: "load" });
    report[name] = { ...(await visit(page)), complaints };
    await page.close();
  }
  const page = await browser.newPage();
  const heard = [];
  page.on("console", (said) => { if (said.type() === "error") heard.push(said.text()); });
  page.on("pageerror", (error) => heard.push(String(error)));
  await page.goto(`${site}/book/index.html`);
  await page.evaluate(() => { console.error("planted"); setTimeout(() => { throw new Error("thrown"); }); });
  await new Promise((done) => { setTimeout(done, 300); });
  report.control = heard;
} finally {
  await browser.close();
}
console.log(JSON.stringify(report));
