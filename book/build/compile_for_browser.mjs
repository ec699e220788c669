// Byte-compile Python files with the very Python that runs in the page: compile_for_browser.mjs SOURCE TARGET [keep]
// Every SOURCE/x.py becomes TARGET/x.pyc, in the place where a module without its source is looked for;
// with `keep`, TARGET/__pycache__/x.cpython-NNN.pyc, to lie beside a source that is kept. Without it docstrings go too.
import { loadPyodide } from "pyodide";

const [source, target, keep = ""] = process.argv.slice(2);
// Node would show the line of an error, which is the whole interpreter.
process.on("uncaughtException", (error) => {
  console.error(error.message);
  process.exit(1);
});
const python = await loadPyodide();
for (const [name, root] of [["/source", source], ["/target", target]]) {
  python.FS.mkdir(name);
  python.FS.mount(python.FS.filesystems.NODEFS, { root }, name);
}
const compiled = python.runPython(`
import ast, importlib.util
from importlib._bootstrap_external import _code_to_hash_pyc
from pathlib import Path

def without_docstrings(tree):
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)) and ast.get_docstring(node, False):
            node.body[:1] = [] if node.body[1:] else [ast.copy_location(ast.Pass(), node.body[0])]
    return tree

def compile_all(keep):
    count = 0
    for path in sorted(Path("/source").rglob("*.py")):
        name = path.relative_to("/source").as_posix()
        content = path.read_bytes()
        tree = ast.parse(content, name)
        code = compile(tree if keep else without_docstrings(tree), name, "exec", dont_inherit=True)
        target = Path("/target") / (importlib.util.cache_from_source(name) if keep else name + "c")
        target.parent.mkdir(parents=True, exist_ok=True)
        # Not checked against its source: that may be gone, or have another date in the page.
        target.write_bytes(_code_to_hash_pyc(code, importlib.util.source_hash(content), False))
        count += 1
    return count
compile_all
`)(keep !== "");
console.log(`${compiled} modules compiled`);
process.exit(0);
