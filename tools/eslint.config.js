// The rules of every script of the project, for tools/lint.

const globals = (names) => Object.fromEntries(names.split(/\s+/).map((name) => [name, "readonly"]));

const everywhere = globals(`Blob CompressionStream DecompressionStream FinalizationRegistry Response
  TextDecoder TextEncoder URL URLSearchParams WebAssembly atob btoa clearTimeout console fetch performance
  process setInterval setTimeout`);
const page = globals(`AudioBufferSourceNode AudioContext OscillatorNode confirm Path2D ResizeObserver Worker
  WorkerGlobalScope document history localStorage location matchMedia modules navigator print
  requestAnimationFrame window`);
const test = globals("Buffer WebSocket");

export default [
  {ignores: ["build/"]},
  {
    files: ["**/*.js", "**/*.mjs"],
    languageOptions: {ecmaVersion: 2022, sourceType: "module", globals: {...everywhere, ...page, ...test}},
    linterOptions: {reportUnusedDisableDirectives: "error"},
    rules: {
      "eqeqeq": "error",
      "max-lines-per-function": ["error", {max: 60, IIFEs: true}],
      "no-redeclare": "error",
      "no-undef": "error",
      "no-unused-vars": "error",
      "no-use-before-define": ["error", {functions: false, classes: false, variables: false}],
      "no-var": "error",
      "prefer-const": ["error", {destructuring: "all"}],
    },
  },
];
