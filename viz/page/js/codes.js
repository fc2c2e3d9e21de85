/* Codes of a 16-bit column that are no finite value: none, plus and minus infinity. */
export const [NOTHING, PLUS, MINUS] = [65535, 65534, 65533];
