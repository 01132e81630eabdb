// Pages, light and dark, on a desktop and a phone: axe's rules of accessibility, no page wider than its window, and a
// search that finds without a server.
// Usage: node check_accessibility.mjs FOLDER CHROMIUM
import fs from "node:fs";
import puppeteer from "puppeteer-core";

const [folder, executablePath] = process.argv.slice(2);
const axe = fs.readFileSync("node_modules/axe-core/axe.min.js", "utf8");
// All that is written by hand, and one page of each kind that is made.
const made = ["reference/cpp/geometry", "reference/glsl/ray_h", "reference/python", "reference/commands/verify", "search"];
const written = fs.readdirSync(folder, { recursive: true })
    .filter((file) => file.endsWith(".html") && !/^(reference|_static|_modules)\/|^(search|genindex|py-modindex)\./.test(file))
    .map((file) => file.replace(/\.html$/, ""));
const pages = [...written, ...made];
const widths = { desktop: 1280, phone: 390 };
const faults = [];

const browser = await puppeteer.launch({ executablePath, headless: true, args: ["--no-sandbox", "--disable-gpu"] });
const tab = await browser.newPage();
for (const [device, width] of Object.entries(widths)) {
    await tab.setViewport({ width, height: 844 });
    for (const scheme of ["light", "dark"]) {
        await tab.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
        for (const page of pages) {
            const where = `${page}, ${device}, ${scheme}`;
            await tab.goto(`file://${folder}/${page}.html`, { waitUntil: "load" });
            const wide = await tab.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
            if (wide > 0) faults.push(`${where}: ${wide} pixels wider than the window`);
            await tab.evaluate(axe);
            const found = await tab.evaluate(() => window.axe.run());
            for (const violation of found.violations) {
                const first = violation.nodes[0];
                faults.push(`${where}: ${violation.id} (${violation.impact}, ${violation.nodes.length}): ` +
                    first.html.slice(0, 120).replaceAll("\n", " "));
            }
        }
    }
}
await tab.goto(`file://${folder}/search.html?q=instance_index`, { waitUntil: "load" });
const results = await tab.waitForSelector("ul.search li a", { timeout: 20000 }).then(() => true, () => false);
if (!results) faults.push("search: finds nothing for instance_index");
await browser.close();
for (const fault of faults) console.error(`check_accessibility: ${fault}`);
console.error(`check_accessibility: ${pages.length} pages, two widths, light and dark: ${faults.length} faults`);
process.exit(faults.length ? 1 : 0);
