"""Cuts files of instruments down to their first 9 rows of 12 points, and adds what another program reads to values.csv.

python cut.py FOLDER, where FOLDER holds the files that FILES names, from SurfaceTopography's own tests
(https://github.com/ContactEngineering/SurfaceTopography, test/file_format_examples, MIT licence).
pip install numpy SurfaceTopography. Headers stay as the instruments wrote them, but for the numbers of points and
bytes, channels and long lists of settings left out, and two heights marked as missing where a format can.
"""
import io
import os
import re
import struct
import sys
import warnings
import zipfile

import numpy as np

warnings.simplefilter("ignore")
import SurfaceTopography as st

out = os.path.dirname(os.path.abspath(__file__))
NX, NY = 12, 9
# Images of a Nanoscope file that are kept.
IMAGES = 2


def nanoscope(raw):
    """The first two images (heights twice, or heights and another quantity)."""
    text = raw[: raw.index(b"\x1a")] if b"\x1a" in raw[:90000] else raw[:40000]
    lines = text.split(b"\r\n")
    sections, kept = [], (b"file list", b"scanner list", b"ciao scan list", b"ciao image list")
    for line in lines:
        if line.startswith(b"\\*"):
            sections.append([line])
        elif sections:
            sections[-1].append(line)
    sections = [s for s in sections if s[0][2:].lower() in kept]
    images = [s for s in sections if b"image list" in s[0].lower()]
    sections = [s for s in sections if s not in images] + images[:IMAGES]
    get = lambda s, key: int(re.search(key + rb": (\d+)", b"\n".join(s))[1])
    blocks, start = [], 6000
    for s in images[:IMAGES]:
        offset, length, columns = get(s, rb"Data offset"), get(s, rb"Data length"), get(s, rb"Samps/line")
        size = length // columns // get(s, rb"Number of lines")
        rows = [raw[offset + i * columns * size:][: NX * size] for i in range(NY)]
        block = b"".join(rows)
        for key, value in ((rb"Data offset", start), (rb"Data length", len(block)), (rb"Samps/line", NX), (rb"Number of lines", NY)):
            s[:] = [re.sub(rb"^\\" + key + rb": \d+", b"\\\\" + key + b": %d" % value, line) for line in s]
        blocks.append(block)
        start += len(block)
    # Settings that say nothing of the heights.
    keep = lambda line: line.startswith(b"\\*") or re.search(rb"^.(@Sens|@2:Image Data|@2:Z scale|Scan Size|Data (off|len)|Bytes/|Samps|Number of lines|Version|Date|Aspect|Frame|Line Dir)", line, re.I)
    head = b"\r\n".join(line for s in sections for line in s if keep(line)) + b"\r\n\\*File list end\r\n\x1a"
    assert len(head) <= 6000, len(head)
    return head.ljust(6000, b"\0") + b"".join(blocks)


def ibw(raw):
    head = bytearray(raw[:384])
    nx, ny, layers = struct.unpack_from("<3i", head, 64 + 68)
    kind = struct.unpack_from("<h", head, 64 + 16)[0]
    size = {2: 4, 4: 8}[kind]
    data = np.frombuffer(raw, f"<f{size}", nx * ny * layers, 384).reshape(layers, ny, nx)
    kept = [0, 1, 2][: layers]
    tail = list(struct.unpack_from("<11I", head, 8))
    note = 384 + data.nbytes + tail[0]
    names = note + sum(tail[1:9])
    labels = raw[names: names + tail[9]]
    columns, rows = min(NX, nx), min(NY, ny)
    data = data[kept, :rows, :columns]
    text = raw[note: note + min(tail[1], 200)]
    labels = labels[: 32 * (len(kept) + 1)]
    struct.pack_into("<11I", head, 8, 0, len(text), 0, 0, 0, 0, 0, 0, 0, len(labels), 0)
    struct.pack_into("<i", head, 4, 320 + data.nbytes)
    struct.pack_into("<i", head, 64 + 12, data.size)
    struct.pack_into("<3i", head, 64 + 68, columns, rows, len(kept))
    struct.pack_into("<h", head, 2, 0)
    total = sum(struct.unpack("<192h", head)) & 0xFFFF
    struct.pack_into("<H", head, 2, -total & 0xFFFF)
    return bytes(head) + data.tobytes() + text + labels


def nid(raw):
    end = raw.index(b"#!") + 2
    head = raw[:end].decode("latin-1")
    names = re.findall(r"^Gr\d-Ch\d=(.*?)\r?$", head, re.M)
    blocks = [raw[end + i * 256 * 256 * 4:][: 256 * 256 * 4] for i in range(len(names))]
    cut = lambda block: np.frombuffer(block, "<i4").reshape(256, 256)[:NY, :NX].tobytes()
    head = re.sub(r"(\[DataSet\\(?:Parameters|Calibration).*?)(?=\[DataSet-0)", "", head, flags=re.S)
    head = re.sub(r"^(Points|Lines)=256 ?(?=\r?$)", lambda m: f"{m[1]}={NX if m[1] == 'Points' else NY}", head, flags=re.M)
    return head.encode("latin-1") + b"".join(map(cut, blocks))


def metropro(raw):
    head = bytearray(raw[:834])
    size, intensities = struct.unpack_from(">I", head, 6)[0], struct.unpack_from(">I", head, 60)[0]
    columns, rows = struct.unpack_from(">2H", head, 68)
    data = np.frombuffer(raw, ">i4", columns * rows, size + intensities).reshape(rows, columns)
    data = data[:NY, :NX].copy()
    data[2, 3] = data[8, 0] = 2147483640
    struct.pack_into(">4H", head, 48, 0, 0, 0, 0)
    struct.pack_into(">H", head, 56, 0)
    struct.pack_into(">I", head, 60, 0)
    struct.pack_into(">2H", head, 68, NX, NY)
    struct.pack_into(">I", head, 72, data.nbytes)
    return bytes(head[:834]).ljust(size, b"\0")[:size] + data.tobytes()


def opd(raw):
    at, blocks = 2, []
    entry = lambda at: (raw[at: at + 16], *struct.unpack_from("<hlH", raw, at + 16))
    count = entry(at)[2] // 24
    entries = [entry(at + 24 * i) for i in range(count)]
    at += 24 * count
    kept = []
    for name, kind, length, attribute in entries[1:]:
        block = raw[at: at + length]
        at += max(length, 0)
        name_text = name.split(b"\0")[0]
        if name_text in (b"RAW DATA", b"RAW_DATA", b"OPD", b"Raw"):
            nx, ny, size = struct.unpack_from("<3H", block)
            data = np.frombuffer(block, f"V{size}", nx * ny, 6).reshape(nx, ny)
            kind_of = {2: "<i2", 4: "<f4"}[size]
            numbers = data.view(kind_of).reshape(nx, ny)[:NX, :NY].copy()
            numbers[3, 2] = numbers[0, 8] = 32767 if size == 2 else 1e38
            block = struct.pack("<3H", NX, NY, size) + numbers.tobytes()
        elif name_text not in (b"Wavelength", b"Mult", b"Aspect", b"Pixel_size", b"Title", b"Date", b"Time"):
            continue
        kept.append((name, kind, len(block), attribute, block))
    head = raw[:2] + entries[0][0] + struct.pack("<hlH", entries[0][1], 24 * (len(kept) + 1), entries[0][3])
    for name, kind, length, attribute, _ in kept:
        head += name + struct.pack("<hlH", kind, length, attribute)
    return head + b"".join(k[4] for k in kept)


def plu(raw):
    head = bytearray(raw[:508])
    rows, columns = struct.unpack_from("<2I", head, 500)
    data = np.frombuffer(raw, "<f4", rows * columns, 508).reshape(rows, columns)[:NY, :NX].copy()
    data[2, 3] = data[8, 0] = 1000001
    struct.pack_into("<2I", head, 388, NY, NX)
    struct.pack_into("<2I", head, 500, NY, NX)
    return bytes(head) + data.tobytes() + struct.pack("<2f", data.min(), data[data < 1e6].max())


def x3p(raw):
    old = zipfile.ZipFile(io.BytesIO(raw))
    xml = old.read("main.xml").decode()
    columns, rows = (int(re.search(f"<Size{a}>(\\d+)", xml)[1]) for a in "XY")
    data = np.frombuffer(old.read("bindata/data.bin"), "<f8").reshape(rows, columns)[:NY, :NX]
    xml = re.sub(r"<SizeX>\d+", f"<SizeX>{NX}", re.sub(r"<SizeY>\d+", f"<SizeY>{NY}", xml))
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as new:
        for name, content in (("bindata/data.bin", data.tobytes()), ("main.xml", xml)):
            new.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)
    return target.getvalue()


def vk4(_):
    """No instrument wrote this one: it is put together from the published description."""
    heights = (np.arange(NX * NY, dtype="<u4") * 7919) % 4001
    table = [0] * 18
    table[0], table[6] = 84, 84 + 4 * 76
    settings = [0] * 76
    settings[:8] = 4 * 76, 2020, 1, 2, 3, 4, 5, 60
    settings[42:45] = 138000, 139000, 100
    image = [NX, NY, 32, 0, heights.nbytes, 0, 0]
    parts = [b"VK4_", bytes(8), struct.pack("<18I", *table), struct.pack("<76I", *settings), struct.pack("<7I", *image), bytes(768)]
    return b"".join(parts) + heights.tobytes()


def vk6(_):
    """The same in an archive behind a prefix."""
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as new:
        new.writestr(zipfile.ZipInfo("Vk4File"), vk4(None), zipfile.ZIP_DEFLATED)
    return b"VK6\0" + bytes(60) + archive.getvalue()


FILES = {
    "bruker_5.spm": ("di-1.di", nanoscope),
    "bruker_10.spm": ("di-5.di", nanoscope),
    "asylum.ibw": ("spot_1-1000nm.ibw", ibw),
    "nanosurf.nid": ("nid-1.nid", nid),
    "zygo.dat": ("metropro-1.dat", metropro),
    "wyko.opd": ("opd-1.opd", opd),
    "sensofar.plu": ("plu-1.plu", plu),
    "mountains.x3p": ("x3p-2.x3p", x3p),
    "description.vk4": (None, vk4),
    "description.vk6": (None, vk6),
}

# Larger maps for whole studies, with the lengths of their part.
SIDE = 48


def scanned(raw):
    """The first image alone."""
    share = SIDE / int(re.search(rb"Samps/line: (\d+)", raw)[1])
    size = lambda found: b"\\Scan Size: " + re.sub(rb"[\d.]+", lambda side: b"%g" % (float(side[0]) * share), found[1])
    text = nanoscope(raw)
    return re.sub(rb"\\Scan Size: ([^\r]*)", size, text[:6000]).rstrip(b"\0").ljust(6000, b"\0") + text[6000:]


MAPS = {
    "bruker_map.spm": ("di-5.di", scanned),
    "zygo_map.dat": ("metropro-1.dat", metropro),
}

# Formats whose first row this reader takes as the greatest y.
FLIPPED = (".spm", ".ibw", ".opd", ".nid")


def row(name):
    topography = st.open_topography(os.path.join(out, name)).topography()
    unit = {"m": 1, "nm": 1e-9, "mm": 1e-3, "pm": 1e-12, "\xb5m": 1e-6}[topography.unit]
    z = np.ma.filled(np.ma.asarray(topography.heights(), float), np.nan).T * unit
    if name.endswith(FLIPPED):
        z = z[::-1]
    picked = [z[0, 0], z[0, 1], z[1, 0], z[-1, -1], np.nanmin(z), np.nanmax(z), np.nanmean(z)]
    sizes = [float(s * unit) for s in topography.physical_sizes]
    return [name, "SurfaceTopography", z.shape[1], z.shape[0], *sizes, int(np.isnan(z).sum()), *(float(v) for v in picked)]


if __name__ == "__main__":
    table = os.path.join(out, "values.csv")
    lines = [line for line in open(table) if line.split(",")[0] not in FILES]
    for name, (original, cut) in FILES.items():
        raw = open(os.path.join(sys.argv[1], original), "rb").read() if original else b""
        with open(os.path.join(out, name), "wb") as file:
            file.write(cut(raw))
        lines.append(",".join(map(str, row(name))) + "\n")
    with open(table, "w") as file:
        file.writelines(lines)
    NX, NY, IMAGES = SIDE, SIDE, 1
    for name, (original, cut) in MAPS.items():
        with open(os.path.join(sys.argv[1], original), "rb") as file:
            raw = file.read()
        with open(os.path.join(out, name), "wb") as file:
            file.write(cut(raw))
