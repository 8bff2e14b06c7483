// An archive of files, not compressed: pictures are, and numbers are few.

const TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let bit = 0; bit < 8; bit++) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
  return n;
});

/** @param {Uint8Array} bytes */
const checksum = (bytes) => (bytes.reduce((sum, byte) => TABLE[(sum ^ byte) & 255] ^ (sum >>> 8), -1) ^ -1) >>> 0;

/**
 * Numbers of two and four bytes, the low one first.
 * @param {...[number, 2 | 4]} numbers
 */
function bytes(...numbers) {
  const view = new DataView(new ArrayBuffer(numbers.reduce((sum, [, size]) => sum + size, 0)));
  let at = 0;
  for (const [value, size] of numbers) {
    if (size === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += size;
  }
  return new Uint8Array(view.buffer);
}

/**
 * @param {{name: string, bytes: Uint8Array}[]} files
 * @returns {Blob}
 */
export function zip(files) {
  /** @type {Uint8Array[][]} */
  const [body, list] = [[], []];
  let begin = 0;
  let size = 0;
  for (const file of files) {
    const name = new TextEncoder().encode(file.name);
    const length = file.bytes.length;
    // Version 2, names in UTF-8, stored, the first of January 1980.
    const facts = bytes([20, 2], [0x800, 2], [0, 2], [0, 2], [0x21, 2], [checksum(file.bytes), 4], [length, 4], [length, 4], [name.length, 2], [0, 2]);
    body.push(bytes([0x04034b50, 4]), facts, name, file.bytes);
    const entry = [bytes([0x02014b50, 4], [20, 2]), facts, bytes([0, 2], [0, 2], [0, 2], [0, 4], [begin, 4]), name];
    list.push(...entry);
    begin += 30 + name.length + length;
    size += 46 + name.length;
  }
  const end = bytes([0x06054b50, 4], [0, 2], [0, 2], [files.length, 2], [files.length, 2], [size, 4], [begin, 4], [0, 2]);
  return new Blob(/** @type {BlobPart[]} */ ([...body, ...list, end]), { type: "application/zip" });
}
