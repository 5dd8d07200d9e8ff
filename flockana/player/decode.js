// Runs from bytes: the reverse of flockana/player/run_codec.py.
function bytesOfText(text) {
  const raw = atob(text.trim());
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

async function decodeRun(data) {
  if (String.fromCharCode(...data.subarray(0, 4)) !== "FLK1") throw new Error("not a run of flockana");
  const stream = new Blob([data.subarray(4)]).stream().pipeThrough(new DecompressionStream("deflate"));
  const raw = new Uint8Array(await new Response(stream).arrayBuffer());
  let start = 4 + new DataView(raw.buffer).getUint32(0, true);
  const run = JSON.parse(new TextDecoder().decode(raw.subarray(4, start)));
  for (const { name, shape, step, origin } of run.arrays) {
    const size = shape.reduce((a, b) => a * b, 1), rows = shape[0], width = rows ? size / rows : 0;
    const whole = new Uint32Array(size);
    for (let column = 0, i = 0; column < width; column++) {
      let sum = 0;
      for (let row = 0; row < rows; row++, i++) {
        const j = start + i;
        sum = (sum + raw[j] + (raw[j + size] << 8) + (raw[j + 2 * size] << 16) + (raw[j + 3 * size] << 24)) >>> 0;
        whole[row * width + column] = sum;
      }
    }
    start += 4 * size;
    run[name] = step === 0 ? new Float32Array(whole.buffer) : Float32Array.from(whole, (k) => origin + step * k);
  }
  return run;
}
