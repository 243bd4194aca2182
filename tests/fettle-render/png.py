"""A decoder of PNG files, by the specification."""
import struct
import zlib


def pixels(data):
    """Rows of (red, green, blue)."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
            assert depth == 8 and colour in (2, 6) and interlace == 0
            channels = 3 if colour == 2 else 4
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    raw, rows, stride = zlib.decompress(packed), [], width * channels
    before = bytearray(stride)
    for row in range(height):
        method = raw[row * (stride + 1)]
        line = bytearray(raw[row * (stride + 1) + 1:(row + 1) * (stride + 1)])
        if method == 1:
            for i in range(channels, stride):
                line[i] = (line[i] + line[i - channels]) & 255
        elif method == 2:
            line = bytearray([(x + above) & 255 for x, above in zip(line, before)])
        elif method == 3:
            for i in range(stride):
                line[i] = (line[i] + ((line[i - channels] if i >= channels else 0) + before[i]) // 2) & 255
        elif method == 4:
            for i in range(stride):
                left, corner = (line[i - channels], before[i - channels]) if i >= channels else (0, 0)
                above = before[i]
                a, b, c = abs(above - corner), abs(left - corner), abs(left + above - 2 * corner)
                line[i] = (line[i] + (left if a <= b and a <= c else above if b <= c else corner)) & 255
        rows.append(list(zip(line[0::channels], line[1::channels], line[2::channels])))
        before = line
    return rows
