// Opens what book/extensions/sealing.py has sealed: the answer is the key.
//
// The browser's own cryptography does it; where a page has none (http from another machine), a library takes ten times
// as long and finds the same.

import { gcm } from "@noble/ciphers/aes.js";
import { pbkdf2Async } from "@noble/hashes/pbkdf2.js";
import { sha256 } from "@noble/hashes/sha2.js";

const LENGTH = 4; // bytes that say how long what is packed is
const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const fromZero = (value, period) => (period === null ? value : value - period * Math.floor(value / period));

/** The password that a list of numbers stands for. */
export const password = (sealed, values) =>
  values.map((value, k) => (sealed.kind === "choice" ? value : Math.floor(fromZero(value - sealed.starts[k], sealed.periods[k]) / sealed.width))).join(",");

const byBrowser = (subtle) => ({
  async derive(secret, salt, rounds) {
    const base = await subtle.importKey("raw", secret, "PBKDF2", false, ["deriveKey"]);
    return subtle.deriveKey({ name: "PBKDF2", hash: "SHA-256", salt, iterations: rounds }, base, { name: "AES-GCM", length: 256 }, false, ["decrypt"]);
  },
  decrypt: async (key, iv, record) => new Uint8Array(await subtle.decrypt({ name: "AES-GCM", iv }, key, record)),
});

const byLibrary = {
  derive: (secret, salt, rounds) => pbkdf2Async(sha256, secret, salt, { c: rounds, dkLen: 32 }),
  decrypt: async (key, iv, record) => gcm(key, iv).decrypt(record),
};

/** What was packed before it was sealed. */
async function unpacked(plain) {
  const packed = plain.slice(LENGTH, LENGTH + new DataView(plain.buffer, plain.byteOffset).getUint32(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"))).json();
}

/** What the records say that these values open. */
async function opened(sealed, values, subtle) {
  const { derive, decrypt } = subtle ? byBrowser(subtle) : byLibrary;
  const key = await derive(new TextEncoder().encode(password(sealed, values)), bytes(sealed.salt), sealed.rounds);
  const found = [];
  for (const record of sealed.records.map(bytes)) {
    const plain = await decrypt(key, record.slice(0, 12), record.slice(12)).catch(() => null);
    if (plain) found.push(await unpacked(plain));
  }
  return found;
}

function agrees(sealed, values, expected) {
  if (sealed.kind === "choice") return true;
  return values.every((value, k) => {
    const period = sealed.periods[k], apart = value - expected[k];
    const nearest = period === null ? apart : fromZero(apart + period / 2, period) - period / 2;
    return Math.abs(nearest) <= sealed.tolerance;
  });
}

/** What was foreseen for these values: {right, says}; {near: true} for what only misses the digits; or null. */
export async function foreseen(sealed, values, subtle = globalThis.crypto?.subtle) {
  const found = await opened(sealed, values, subtle);
  const exact = found.find(({ value }) => agrees(sealed, values, value));
  if (exact) return { right: exact.right, says: exact.says };
  return found.some(({ right }) => right) ? { near: true } : null;
}
