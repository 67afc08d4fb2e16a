// A scene as part of an address: its file, packed and encoded without escapes. The hash of the shot is
// included, so that the recipient sees whether the bits are the same.

// [bytes] Longer addresses, and longer files in them, are rejected.
export const LONGEST_FRAGMENT = 60000;
const LONGEST_SCENE = 400000;

async function piped(bytes, through, most) {
  const reader = new Blob([bytes]).stream().pipeThrough(through).getReader(), parts = [];
  let size = 0;
  for (;;) {
    const {done, value} = await reader.read();
    if (done) break;
    size += value.length;
    if (size > most) {
      reader.cancel().catch(() => {});
      throw new Error("the scene in it is too long");
    }
    parts.push(value);
  }
  return new Blob(parts).arrayBuffer();
}

const toLetters = (bytes) => {
  let text = "";
  for (const byte of new Uint8Array(bytes)) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
};
const fromLetters = (letters) =>
  Uint8Array.from(atob(letters.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));

/** "#h=HASH&s=SCENE" */
export async function fragmentOf(toml, hash) {
  const packed = await piped(new TextEncoder().encode(toml), new CompressionStream("deflate-raw"), Infinity);
  return `#h=${hash}&s=${toLetters(packed)}`;
}

/** {toml, hash} of an address, or null if it contains no scene. @throws Error with a sentence */
export async function sceneInFragment(fragment) {
  const found = /^#h=([0-9a-f]{16})&s=([A-Za-z0-9_-]+)$/.exec(fragment);
  if (!/[#&]s=/.test(fragment)) return null;
  if (fragment.length > LONGEST_FRAGMENT) throw new Error("The address is too long for a scene.");
  if (!found) throw new Error("The address is incomplete or was altered.");
  try {
    const bytes = await piped(fromLetters(found[2]), new DecompressionStream("deflate-raw"), LONGEST_SCENE);
    return {hash: found[1], toml: new TextDecoder("utf-8", {fatal: true}).decode(bytes)};
  } catch {
    throw new Error("The address is incomplete or was altered.");
  }
}

/** The bytes of carom.wasm from the page's data: base64 of gzip. */
export async function wasmOfPage(letters) {
  return piped(fromLetters(letters), new DecompressionStream("gzip"), Infinity);
}
