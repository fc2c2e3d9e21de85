/* Reads back what the page carries: a JSON header, and gzipped bytes in base64 blocks. */

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Promise of {header, segments: Map of name to Uint8Array}; rejects where the file is damaged or cut. */
export async function unpack() {
  const header = JSON.parse(document.getElementById("header").textContent);
  const blocks = [...document.querySelectorAll("script.block")];
  const length = blocks.reduce((sum, block) => sum + block.textContent.length, 0);
  if (length !== header.packed) throw new Error("the file is cut short: save it again");
  if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old: it cannot unpack gzip");
  let next = 0;
  const source = new ReadableStream({
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
  const total = header.segments.reduce((sum, [, size]) => sum + size, 0);
  const all = new Uint8Array(total);
  let filled = 0;
  const reader = source.pipeThrough(new DecompressionStream("gzip")).getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (filled + value.length > total) throw new Error("the file is damaged: save it again");
    all.set(value, filled);
    filled += value.length;
  }
  if (filled !== total) throw new Error("the file is damaged: save it again");
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
