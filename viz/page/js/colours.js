/* Colours of values: cividis, or PuOr about zero where a measure has both signs; orange is the worse side. */

const CIVIDIS =
  "00224e 002e6a 1a386f 32436d 434e6c 535a6d 61656f 6f7073 7d7c78 8c8878 9b9476 aba072 bcae6c cdbb63 dec958 f0d846 fee838";
const PUOR =
  "7f3b08 a04d07 be630a db7d12 ef9e3c fdbd6e fed7a2 fbe9cf f6f6f7 e3e4ef cecde4 b6b0d4 988dbe 7967a6 5d3790 44176f 2d004b";

const parse = (text) => text.split(" ").map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)));
const [EVEN, SIGNED] = [parse(CIVIDIS), parse(PUOR)];

/** {low, high, signed, colour(value), rgb(value)} for a measure over its settled cases. */
export function scaleOf(cases, measure) {
  let [low, high] = [cases.quantile(measure.name, 0.01), cases.quantile(measure.name, 0.99)];
  const signed = low < 0 && high > 0 && Math.min(-low, high) > 0.02 * (high - low);
  if (signed) [low, high] = [-Math.max(-low, high), Math.max(-low, high)];
  if (!(high > low)) [low, high] = Number.isFinite(low) ? [low - 0.5 * Math.abs(low || 1), low + 0.5 * Math.abs(low || 1)] : [0, 1];
  const stops = signed ? SIGNED : EVEN;
  // With cividis dark is worse, with PuOr orange is worse, whichever way the measure goes.
  const turned = measure.better === "low";
  const rgb = (value) => {
    let t = Math.min(1, Math.max(0, (value - low) / (high - low)));
    if (turned) t = 1 - t;
    const at = Math.min(stops.length - 2, Math.floor(t * (stops.length - 1)));
    const part = t * (stops.length - 1) - at;
    return stops[at].map((from, k) => Math.round(from + part * (stops[at + 1][k] - from)));
  };
  return { low, high, signed, rgb, colour: (value) => `rgb(${rgb(value).join(",")})` };
}
