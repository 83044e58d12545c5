"""Makes the height files of this folder with other programs, and values.csv with what other programs read from them.

pip install numpy SurfaceTopography surfalize gwyfile gsffile rasterio pillow tifffile imagecodecs pypng; then python make.py.
The files gwyddion.* are left as they are: Gwyddion 2.62 saved them from the heights h below.
"""
import glob
import io
import os
import sys
import warnings

import numpy as np

warnings.simplefilter("ignore")
out = os.path.dirname(os.path.abspath(__file__))
p = lambda n: os.path.join(out, n)
NX, NY = 12, 9
DX, DY = 50e-9, 80e-9
rng = np.random.default_rng(7)
y, x = np.mgrid[0:NY, 0:NX]
h = 60e-9*np.sin(2*np.pi*x/NX + 0.4) + 4e-9*y + 25e-9*rng.standard_normal((NY, NX))   # [row, column], m

import SurfaceTopography as st
import surfalize, rasterio, rasterio.shutil, tifffile
from PIL import Image
from rasterio.transform import from_origin
import gwyfile
from gwyfile.objects import GwyContainer, GwyDataField

holes = h.copy(); holes[2, 3] = holes[8, 0] = np.nan
# surfalize: lengths in um
s = surfalize.Surface(h*1e6, DX*1e6, DY*1e6)
sh = surfalize.Surface(holes*1e6, DX*1e6, DY*1e6)
s.save(p("surfalize.sur"))
sh.save(p("surfalize_holes.sur"))
sh.save(p("surfalize.al3d"))
sh.save(p("surfalize_binary.sdf"))
sh.save(p("surfalize_text.sdf"), binary=False)
# gwyfile
c = GwyContainer()
c['/0/data/title'] = 'Phase'
c['/0/data'] = GwyDataField(np.random.default_rng(1).random((NY, NX)), xreal=NX*DX, yreal=NY*DY, si_unit_xy='m', si_unit_z='deg')
c['/1/data/title'] = 'Height'
c['/1/data'] = GwyDataField(h, xreal=NX*DX, yreal=NY*DY, si_unit_xy='m', si_unit_z='m')
c['/1/mask'] = GwyDataField(np.where(np.isnan(holes), 1.0, 0.0), xreal=NX*DX, yreal=NY*DY, si_unit_xy='m', si_unit_z='')
c.tofile(p("gwyfile_mask.gwy"))
# GDAL through rasterio: coordinates in nm, heights in nm; north up, so row 0 of the array is the greatest y
t = from_origin(-0.5*DX*1e9, (NY-0.5)*DY*1e9, DX*1e9, DY*1e9)
for name, driver, dtype, nodata in [("gdal_text.grd", "GSAG", "float64", None), ("gdal_6.grd", "GSBG", "float32", None), ("gdal_7.grd", "GS7BG", "float64", None), ("gdal.xyz", "XYZ", "float32", None)]:
    mem = rasterio.MemoryFile()
    a = (holes if driver.startswith("GS") else h)[::-1]*1e9
    a = np.where(np.isnan(a), 1.701410009187828e+38, a).astype(dtype)
    with mem.open(driver="GTiff", width=NX, height=NY, count=1, dtype=dtype, transform=t, nodata=1.701410009187828e+38 if driver.startswith("GS") else None) as d:
        d.write(a, 1)
    with mem.open() as d:
        rasterio.shutil.copy(d, p(name), driver=driver)
    for extra in (p(name)+".aux.xml",):
        if os.path.exists(extra): os.remove(extra)
# images
g16 = np.round((h-h.min())/(h.max()-h.min())*65535).astype(np.uint16)
g8 = (g16 >> 8).astype(np.uint8)
Image.fromarray(g8).save(p("pillow_8.png"))
Image.fromarray(g16).save(p("pillow_16.png"))
Image.fromarray(g8).save(p("pillow_lzw.tif"), compression="tiff_lzw")
tifffile.imwrite(p("tifffile_8.tif"), g8)
tifffile.imwrite(p("tifffile_16.tif"), g16, byteorder='>')
tifffile.imwrite(p("tifffile_white_is_zero.tif"), (65535-g16).astype(np.uint16), photometric='miniswhite')
tifffile.imwrite(p("tifffile_deflate.tif"), g16, compression='zlib', predictor=True, tile=(16,16))
tifffile.imwrite(p("tifffile_float.tif"), (h*1e9).astype(np.float32))
# One strip or few, packed in all ways; the last with 0 as white.
f32 = (h*1e9).astype(np.float32)
tifffile.imwrite(p("tifffile_planes.tif"), f32, compression='zlib', predictor=3, byteorder='>', rowsperstrip=NY)
tifffile.imwrite(p("tifffile_planes_64.tif"), f32.astype(np.float64), compression='zlib', predictor=3, tile=(16, 16))
tifffile.imwrite(p("tifffile_strips.tif"), g16, compression='lzw', predictor=2, byteorder='>', rowsperstrip=4)
with rasterio.open(p("gdal_differences.tif"), "w", driver="GTiff", width=NX, height=NY, count=1, dtype="float32", compress="LZW", predictor=2, blockysize=NY) as d:
    d.write(f32, 1)
tifffile.imwrite(p("tifffile_packbits.tif"), (255-g8).astype(np.uint8), compression='packbits', photometric='miniswhite', rowsperstrip=NY)
import png
with open(p("pypng_interlaced.png"), "wb") as file:
    png.Writer(NX, NY, greyscale=True, bitdepth=16, interlace=True).write(file, g16.tolist())
# NumPy
np.save(p("numpy_half.npy"), (h*1e9).astype(np.float16))
np.save(p("numpy_fortran.npy"), np.asfortranarray((h*1e9).astype('>f4')))
np.savetxt(p("numpy_columns.csv"), np.c_[(x*DX*1e9).ravel(), (y*DY*1e9).ravel(), (h*1e9).ravel()], fmt="%.6g", delimiter=",", header="x,y,z", comments="")
# SurfaceTopography itself: matrix with its size
topo = st.Topography(h.T, (NX*DX, NY*DY), unit="m")
topo.to_matrix(p("surfacetopography.txt"))


def read(path):
    """Reader, heights [row, column] in m or shades from 0 to 1, size in m or None."""
    name = os.path.basename(path)
    if name.endswith(".gsf"):
        import gsffile
        data, head = gsffile.read_gsf(path)
        return "gsffile", np.asarray(data, float), (head["XReal"], head["YReal"])
    if name.endswith((".grd", ".png", ".tif")):
        with rasterio.open(path) as d:
            data = d.read(1).astype(float)
            shades = {"uint8": 255, "uint16": 65535}.get(d.dtypes[0])
            if name.endswith(".grd"):
                data[data >= 1.7e38] = np.nan
                # North is up there; the unit of all three coordinates is nm here.
                return "GDAL", data[::-1] * 1e-9, (d.width * d.transform.a * 1e-9, -d.height * d.transform.e * 1e-9)
        if "white_is_zero" in name or "packbits" in name:
            data = shades - data
        return "GDAL", data / shades if shades else data * 1e-9, None
    if name.endswith(".npy"):
        return "NumPy", np.load(path).astype(float) * 1e-9, None
    if name == "gwyddion.txt":
        # It says no size.
        return "SurfaceTopography", st.read_topography(path, physical_sizes=(1, 1)).heights().T, None
    if name == "gwyddion.sdf":
        # The reader knows the magic word of the standard only.
        path = io.BytesIO(open(path, "rb").read().replace(b"aBCR-0.0", b"aISO-1.0"))
    t = st.read_topography(path)
    z = np.ma.filled(np.ma.asarray(t.heights(), float), np.nan).T
    # The least double marks missing points in .sdf, which this reader keeps.
    z[np.abs(z) > 1e100] = np.nan
    unit = {"m": 1, "nm": 1e-9, "pm": 1e-12, "\xb5m": 1e-6, "\xc2\xb5m": 1e-6, None: 1e-9}[t.unit]
    if name in ("gwyddion.xyz",):
        unit = 1
    return "SurfaceTopography", z * unit, tuple(s * unit for s in t.physical_sizes)


with open(p("values.csv"), "w") as table:
    table.write("file,reader,columns,rows,size_x,size_y,missing,first,next_in_row,next_in_column,last,least,greatest,mean\n")
    for path in sorted(glob.glob(p("*.*"))):
        if path.endswith((".py", ".md", "values.csv")):
            continue
        reader, z, size = read(path)
        picked = [z[0, 0], z[0, 1], z[1, 0], z[-1, -1], np.nanmin(z), np.nanmax(z), np.nanmean(z)]
        fields = [os.path.basename(path), reader, z.shape[1], z.shape[0], *(["", ""] if size is None else [float(s) for s in size]), int(np.isnan(z).sum()), *(float(v) for v in picked)]
        table.write(",".join(map(str, fields)) + "\n")
