"""Pictures without a library: writes and reads 8-bit RGB PNG files, and writes letters into an array of pixels."""
import struct
import zlib

import numpy as np

# Five columns a letter, the lowest bit above.
LETTERS = dict(zip("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-%_:,/()+<", (bytes.fromhex(columns) for columns in """
    7e1111117e 7f49494936 3e41414122 7f4141221c 7f49494941 7f09090901 3e4149497a 7f0808087f 00417f4100 2040413f01 7f08142241
    7f40404040 7f020c027f 7f0408107f 3e4141413e 7f09090906 3e4151215e 7f09192946 4649494931 01017f0101 3f4040403f 1f2040201f
    3f4038403f 6314081463 0708700807 6151494543 3e5149453e 00427f4000 4261514946 2141454b31 1814127f10 2745454539 3c4a494930
    0171090503 3649494936 064949291e 0060600000 0808080808 2313086462 4040404040 0036360000 0050300000 2010080402 001c224100
    0041221c00 08083e0808 0814224100""".split())))


def text_mask(text, scale=1):
    """What a line of text covers: 7 rows, 6 columns a letter, times the scale; small letters look like capitals."""
    columns = [byte for letter in text.upper() for byte in LETTERS.get(letter, bytes(5)) + b"\0"]
    mask = (np.array(columns, int)[None, :] >> np.arange(7)[:, None]) & 1 == 1
    return mask.repeat(scale, 0).repeat(scale, 1)


def write_text(pixels, x, y, text, colour=(40, 40, 40), scale=1):
    """With its upper left corner at (x, y); what lies outside is cut off."""
    mask = text_mask(text, scale)[:max(0, len(pixels) - y), :max(0, pixels.shape[1] - x)]
    pixels[y:y + mask.shape[0], x:x + mask.shape[1]][mask] = colour


def encode(pixels):
    height, width, _ = pixels.shape
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = np.hstack([np.zeros((height, 1), np.uint8), pixels.astype(np.uint8).reshape(height, -1)])
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))


def decode(data):
    """Of a file as encode writes it, without filters; checks every chunk's sum."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + body)
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
            assert body[8:] == bytes([8, 2, 0, 0, 0])
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, -1)
    assert not rows[:, 0].any()
    return rows[:, 1:].reshape(height, width, 3)
