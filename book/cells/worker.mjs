// Python beside the page: one worker, started at the first Run, ended by Stop.

let python = null;
let kernel = null;

const tell = (message) => postMessage(message);

/** Count what is fetched, as it arrives. */
function count(bytes) {
  const plain = globalThis.fetch;
  const arrived = {};
  const total = Object.values(bytes).reduce((sum, size) => sum + size, 0);
  globalThis.fetch = async (...what) => {
    const answer = await plain(...what);
    const address = answer.url;
    const name = Object.keys(bytes).find((file) => address.split(/[?#]/)[0].endsWith(file));
    if (!name || !answer.ok || !answer.body) return answer;
    const counter = new TransformStream({
      transform(chunk, out) {
        arrived[name] = (arrived[name] ?? 0) + chunk.byteLength;
        const loaded = Object.entries(arrived).reduce((sum, [file, size]) => sum + Math.min(size, bytes[file]), 0);
        tell({ type: "loaded", loaded, total });
        out.enqueue(chunk);
      },
    });
    return new Response(answer.body.pipeThrough(counter), { status: answer.status, headers: answer.headers });
  };
}

async function boot({ root, interpreter, lock, bytes, book, files, imports }) {
  const times = [];
  const step = (text) => { times.push([text, performance.now()]); tell({ type: "step", text, step: times.length, steps: 4 }); };
  count(bytes);
  step("Python");
  const { loadPyodide } = await import(`${root}${interpreter}pyodide.mjs`);
  const quiet = () => {};
  python = await loadPyodide({
    indexURL: root + interpreter, lockFileURL: root + lock, packageBaseUrl: root, stdout: quiet, stderr: quiet, env: { HOME: "/home/pyodide", MPLBACKEND: "agg" },
  });
  step("numpy, SymPy and dhlib");
  const missing = [];
  const note = (text) => missing.push(text);
  await python.loadPackage(["numpy", "dhlib"], { messageCallback: () => {}, errorCallback: note, checkIntegrity: true });
  step("the book's own helpers");
  const archive = await (await fetch(root + book)).arrayBuffer();
  python.FS.mkdirTree("/book");
  python.unpackArchive(archive, "zip", { extractDir: "/book" });
  for (const [path, address] of Object.entries(files)) {
    const answer = await fetch(address);
    if (!answer.ok) throw new Error(`${address} is not there.`);
    python.FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    python.FS.writeFile(path, new Uint8Array(await answer.arrayBuffer()));
  }
  step("imports");
  python.runPython(`import sys; sys.path[:0] = ["/book", "/book/live"]`);
  if (missing.length) throw new Error(missing.at(-1));
  python.runPython(imports);
  kernel = python.pyimport("kernel").start((output) => tell({ type: "output", output: JSON.parse(output) }), "/home/pyodide/book");
  times.push(["ready", performance.now()]);
  tell({ type: "ready", times: times.slice(1).map(([, end], k) => [times[k][0], end - times[k][1]]) });
}

onmessage = async ({ data }) => {
  try {
    if (data.type === "boot") await boot(data);
    // The page has asked its reader before it sends such a cell.
    if (data.packages?.length) await python.loadPackage(data.packages);
    if (data.type === "run") tell({ type: "ran", id: data.id, good: kernel.run(data.source, data.name, JSON.stringify(data.figures)) });
    if (data.type === "call") {
      // A function of a module of the page, with plain values in and JSON out.
      tell({ type: "called", id: data.id, result: JSON.parse(kernel.call(data.module, data.name, JSON.stringify(data.values))) });
    }
  } catch (error) {
    const text = String(error.message ?? error);
    tell({ type: "broken", id: data.id, text: text.trim().split("\n").at(-1), whole: text });
  }
};
