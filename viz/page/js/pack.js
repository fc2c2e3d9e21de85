/* Reads back what the page carries: a JSON header, and gzipped bytes in base64 blocks. */

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const CUT_SHORT = "the file is cut short: save it again";
const DAMAGED = "the file is damaged: save it again";

/* The gzipped blocks one after the other; each is let go once it is read. */
function packedBytes(blocks) {
  let next = 0;
  return new ReadableStream({
    pull(controller) {
      if (next === blocks.length) {
        controller.close();
        return;
      }
      controller.enqueue(bytesOf(blocks[next].textContent));
      blocks[next].textContent = "";
      next += 1;
    },
  });
}

async function unpacked(blocks, total) {
  const all = new Uint8Array(total);
  let filled = 0;
  const reader = packedBytes(blocks).pipeThrough(new DecompressionStream("gzip")).getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (filled + value.length > total) throw new Error(DAMAGED);
    all.set(value, filled);
    filled += value.length;
  }
  if (filled !== total) throw new Error(DAMAGED);
  return all;
}

function headerOf() {
  try {
    return JSON.parse(document.getElementById("header").textContent);
  } catch {
    throw new Error(DAMAGED);
  }
}

/** Promise of {header, segments: Map of name to Uint8Array}; rejects where the file is damaged or cut. */
export async function unpack() {
  const header = headerOf();
  const blocks = [...document.querySelectorAll("script.block")];
  const length = blocks.reduce((sum, block) => sum + block.textContent.length, 0);
  if (length !== header.packed) throw new Error(CUT_SHORT);
  if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old: it cannot unpack gzip; open the page in a newer one");
  const total = header.segments.reduce((sum, [, size]) => sum + size, 0);
  let all;
  try {
    all = await unpacked(blocks, total); // gzip's own sum of the bytes is checked at its end
  } catch (error) {
    throw error instanceof RangeError ? new Error("this browser has too little memory for so many cases; take fewer, or the netCDF file") : new Error(DAMAGED);
  }
  const segments = new Map();
  let start = 0;
  for (const [name, size] of header.segments) {
    segments.set(name, all.subarray(start, start + size));
    start += size;
  }
  return { header, segments };
}

/** Split a run of commands, each behind its length in four bytes. */
export function commandsOf(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const commands = [];
  for (let at = 0; at < bytes.length; ) {
    const size = view.getUint32(at, true);
    commands.push(bytes.subarray(at + 4, at + 4 + size));
    at += 4 + size;
  }
  return commands;
}
