"""Cuts force curves of instruments down to a few points, and writes what another program reads to curves.csv.

python cut_curves.py FOLDER, where FOLDER holds the files that FILES names, from afmformats' own tests
(https://github.com/AFM-analysis/afmformats, tests/data, MIT licence). pip install numpy afmformats. Headers stay as the
instruments wrote them, but for the numbers of points. nanoscope_force.spm is put together here.
"""
import os
import re
import struct
import sys
import zipfile

import numpy as np

out = os.path.dirname(os.path.abspath(__file__))
# Name, original, and of how many points one is kept.
FILES = {
    "jpk_alone.jpk-force": ("fmt-jpk-fd_spot3-0192.jpk-force", 16),
    "jpk_shared.jpk-force": ("fmt-jpk-fd_single-modified_2023.jpk-force", 100),
}


def jpk(raw, target, every):
    old = zipfile.ZipFile(raw)
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as new:
        for entry in old.infolist():
            content = old.read(entry)
            if entry.filename.endswith(".dat"):
                size = 2 if b"encoder.type=signedshort" in old.read(entry.filename.rsplit("/", 2)[0] + "/segment-header.properties") else 4
                data = np.frombuffer(content, f">i{size}")[::every]
                content = data.tobytes()
            elif entry.filename.endswith("segment-header.properties"):
                count = lambda found: found[1] + str(-(-int(found[2]) // every)).encode()
                content = re.sub(rb"(num-points=)(\d+)", count, content)
            new.writestr(zipfile.ZipInfo(entry.filename), content, zipfile.ZIP_DEFLATED)


def nanoscope():
    """No instrument wrote this one: a paraboloid of 50 nm pressed into 100 MPa by a cantilever of 0.4 N/m, without noise."""
    points, ramp, sensitivity, spring, step = 128, 300e-9, 60e-9, 0.4, 0.000375
    position = np.linspace(0, ramp, points)
    stiffness = 4 / 3 * 100e6 * np.sqrt(50e-9)
    deflection = np.zeros(points)
    for i, p in enumerate(position - 0.6 * ramp):
        low, high = 0.0, max(p, 0.0)
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if spring * middle < stiffness * max(p - middle, 0.0) ** 1.5 else (low, middle)
        deflection[i] = low
    numbers = np.round(deflection / sensitivity / step).astype("<i2")
    # The extension backwards in time, as many versions store it, then the retraction.
    data = numbers[::-1].tobytes() + numbers[::-1].tobytes()
    lines = [
        r"\*Force file list", r"\Version: 0x08150300", r"\*Scanner list", r"\@Sens. Zsens: V 20 nm/V", r"\*Ciao scan list",
        r"\@Sens. DeflSens: V 60 nm/V", r"\*Ciao force image list", r"\Data offset: 2048", rf"\Data length: {len(data)}",
        r"\Bytes/pixel: 2", rf"\Samps/line: {points} {points}", rf"\Spring Constant: {spring}",
        r'\@4:Image Data: S [DeflectionError] "Deflection Error"', rf"\@4:Z scale: V [Sens. DeflSens] ({step:.6f} V/LSB) 24.576 V",
        r"\@4:Ramp size: V [Sens. Zsens] (0.006713867 V/LSB) 15 V", r"\*File list end",
    ]
    head = "\r\n".join(lines).encode() + b"\r\n\x1a"
    return head.ljust(2048, b"\0") + data


if __name__ == "__main__":
    import afmformats

    rows = ["file,time [s],height [m],force [N]"]
    for name, (original, every) in FILES.items():
        path = os.path.join(out, name)
        jpk(os.path.join(sys.argv[1], original), path, every)
        meta = {} if name != "jpk_shared.jpk-force" else {"spring constant": 0.05}
        for data in afmformats.load_data(path, meta_override=meta):
            for at in (0, 1, len(data["force"]) // 2, len(data["force"]) - 1):
                rows.append(",".join([name, *(repr(float(data[key][at])) for key in ("time", "height (measured)", "force"))]))
    with open(os.path.join(out, "nanoscope_force.spm"), "wb") as file:
        file.write(nanoscope())
    with open(os.path.join(out, "curves.csv"), "w") as file:
        file.write("\n".join(rows) + "\n")
