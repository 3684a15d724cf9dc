"""Reads single-part scanline OpenEXR files (uncompressed, ZIPS, ZIP; half, float, uint) with numpy alone."""
import struct
import zlib

import numpy as np


def read(path):
    """(height, width) float arrays by channel name, e.g. {"R": ..., "primary.R": ...}."""
    data = open(path, "rb").read()
    if struct.unpack_from("<I", data)[0] != 20000630:
        raise ValueError(f"{path}: not an OpenEXR file")
    if struct.unpack_from("<I", data, 4)[0] & 0x1A00:
        raise ValueError(f"{path}: tiled, deep or multi-part files are not read here")
    at, attributes = 8, {}

    def text(at):
        end = data.index(b"\0", at)
        return data[at:end].decode(), end + 1

    while data[at]:
        name, at = text(at)
        _, at = text(at)
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    at += 1
    channels, raw, i = [], attributes["channels"], 0
    while raw[i]:
        end = raw.index(b"\0", i)
        channels.append((raw[i:end].decode(), struct.unpack_from("<i", raw, end + 1)[0]))
        i = end + 17
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    compression = attributes["compression"][0]
    if compression not in (0, 2, 3):
        raise ValueError(f"{path}: compression {compression} is not read here (expected none, ZIPS or ZIP)")
    rows = 16 if compression == 3 else 1
    types = {0: "<u4", 1: "<f2", 2: "<f4"}
    out = {name: np.empty((height, width), np.float64) for name, _ in channels}
    line = sum(width * np.dtype(types[t]).itemsize for _, t in channels)
    for offset in np.frombuffer(data, "<u8", (height + rows - 1) // rows, at):
        y, size = struct.unpack_from("<ii", data, int(offset))
        n = min(rows, height - (y - y0))
        block = data[int(offset) + 8:int(offset) + 8 + size]
        if compression and size < n * line:
            b = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
            b = np.cumsum(np.concatenate([b[:1], b[1:] - 128])).astype(np.uint8)   # undo the byte-to-byte difference
            half = (len(b) + 1) // 2
            block = np.empty(len(b), np.uint8)
            block[0::2], block[1::2] = b[:half], b[half:]
            block = block.tobytes()
        i = 0
        for row in range(n):
            for name, t in channels:
                out[name][y - y0 + row] = np.frombuffer(block, types[t], width, i)
                i += width * np.dtype(types[t]).itemsize
    return out


def rgb(path, layer=""):
    """(height, width, 3) of a layer; the unnamed one by default."""
    channels = read(path)
    prefix = layer + "." if layer else ""
    for names in ([prefix + c for c in "RGB"], ["Combined." + c for c in "RGB"]):
        if all(n in channels for n in names):
            return np.stack([channels[n] for n in names], 2)
    raise ValueError(f"{path}: no channels {prefix}R, {prefix}G, {prefix}B (has {', '.join(sorted(channels))})")
