// A column of numbers, lowest byte first, from base64.
function column(text, kind) {
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
  return new kind(bytes.buffer);
}
