// Bundle scripts of the pages: each a classic script of its own, so that it also runs from file://.
// Arguments: the folder to write into, and the scripts, as web/NAME or cells/NAME; all of one folder.
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const [into, ...names] = process.argv.slice(2);
await build({
  entryPoints: names.map((name) => fileURLToPath(new URL(`../${name}.js`, import.meta.url))),
  outdir: into,
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "eof",
  loader: { ".css": "text" },
});
