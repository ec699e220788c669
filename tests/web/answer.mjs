// Call functions of a module: its path is the argument, the calls stand on standard input as JSON.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const module = await import(pathToFileURL(process.argv[2]));
const calls = JSON.parse(readFileSync(0, "utf-8"));
console.log(JSON.stringify(await Promise.all(calls.map(([name, ...given]) => module[name](...given)))));
