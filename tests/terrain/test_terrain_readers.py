"""Files of heights: what is read, in which order, with which spacing."""

import numpy as np
import pytest
import tifffile

from rover_pin.errors import TerrainError
from rover_pin.terrain import Terrain
from rover_pin.terrain.readers import HeightMap, reader, suffixes
from rover_pin.terrain.readers import registry as reader_registry

Z = np.round(np.random.default_rng(0).normal(size=(4, 6)), 3)


def geotiff(path, heights, scale=None, tie=True, geo=None, nodata=None):
    tags = []
    if scale is not None:
        tags.append((33550, "d", 3, (*scale, 0.0), True))
    if tie:
        tags.append((33922, "d", 6, (0.0, 0.0, 0.0, -23.5, 21.5, 0.0), True))
    if geo is not None:
        keys = [1, 1, 0, len(geo)] + [v for k, value in sorted(geo.items()) for v in (k, 0, 1, value)]
        tags.append((34735, "H", len(keys), tuple(keys), True))
    if nodata is not None:
        tags.append((42113, "s", len(nodata) + 1, nodata, True))
    tifffile.imwrite(path, heights, extratags=tags)
    return path


def write(path):
    kind = path.suffix
    if kind in (".tif", ".tiff"):
        tifffile.imwrite(path, Z)
    elif kind == ".npy":
        np.save(path, Z)
    elif kind == ".npz":
        np.savez(path, z=Z)
    else:
        np.savetxt(path, Z, delimiter=",")
    return path


@pytest.mark.parametrize("name", ["a.tif", "a.tiff", "A.TIF", "a.npy", "a.npz", "a.csv"])
@pytest.mark.parametrize("interpolation", ["smooth", "linear"])
def test_rows_run_along_y_in_the_files_order(tmp_path, name, interpolation):
    path = tmp_path / name
    write(path.with_suffix(path.suffix.lower()))
    path.with_suffix(path.suffix.lower()).rename(path)
    terrain = Terrain.from_file(path, 0.5, interpolation=interpolation)
    i, j = np.indices(Z.shape)
    np.testing.assert_allclose(terrain.height(0.5 * j, 0.5 * i), Z, atol=1e-12)
    assert terrain.extent == (0.0, 2.5, 0.0, 1.5)
    assert terrain.label == name
    moved = Terrain.from_file(str(path), 0.5, (10.0, -1.0), interpolation)
    assert moved.height(10.0 + 2.5, -1.0) == pytest.approx(Z[0, 5])
    assert Terrain.parse(str(path), 0.5, interpolation).digest == terrain.digest


@pytest.mark.parametrize("name", ["a.tif", "a.npy", "a.npz", "a.csv"])
def test_without_a_spacing(tmp_path, name):
    path = write(tmp_path / name)
    with pytest.raises(TerrainError) as caught:
        Terrain.from_file(path)
    assert str(caught.value) == (
        f"{path}: the map has no spacing; give the metres from node to node: --spacing, or spacing="
    )


def test_a_geotiff_gives_its_spacing_and_a_stated_one_overrides(tmp_path):
    path = geotiff(tmp_path / "g.tif", Z.astype(np.float32), (0.25, 0.25), geo={1024: 1, 3076: 9001})
    terrain = Terrain.from_file(path)
    assert terrain.spacing == 0.25
    assert terrain.extent == (0.0, 1.25, 0.0, 0.75)
    assert terrain.height(0.25, 0.5) == pytest.approx(float(np.float32(Z[2, 1])), abs=1e-7)
    assert Terrain.from_file(path, 0.1).spacing == 0.1


@pytest.mark.parametrize(
    ("scale", "geo", "message"),
    [
        ((0.25, 0.3), None, "unequal pixel scales (got '0.25 x 0.3'); resample to square pixels in metres"),
        ((1e-5, 1e-5), {1024: 2}, "the pixel scale is an angle"),
        ((1.0, 1.0), {1024: 1, 3076: 9003}, "the pixel scale is not in metres (got 'unit 9003')"),
        ((0.0, 0.0), None, "the map's spacing must be positive"),
    ],
)
def test_a_geotiff_scale_that_cannot_be_used(tmp_path, scale, geo, message):
    path = geotiff(tmp_path / "g.tif", Z, scale, geo=geo)
    with pytest.raises(TerrainError) as caught:
        Terrain.from_file(path)
    assert message in str(caught.value)
    assert str(caught.value).startswith(f"{path}: ")
    assert Terrain.from_file(path, 0.5).spacing == 0.5


def test_cells_without_data(tmp_path):
    heights = Z.astype(np.float32)
    heights[1, 3] = -9999.0
    path = geotiff(tmp_path / "g.tif", heights, nodata="-9999")
    with pytest.raises(
        TerrainError, match=r"no data \(GDAL_NODATA -9999\) in 1 of 24 cells, the first at row 1, column 3"
    ):
        Terrain.from_file(path, 1.0)
    assert Terrain.from_file(geotiff(tmp_path / "h.tif", Z, nodata="-9999"), 1.0).spacing == 1.0


def test_tiffs_of_another_sort(tmp_path):
    colour = tmp_path / "c.tif"
    tifffile.imwrite(colour, np.zeros((8, 8, 3), dtype=np.uint8), photometric="rgb")
    with pytest.raises(TerrainError, match=r"not two-dimensional \(got \(8, 8, 3\)\); .*single band"):
        Terrain.from_file(colour, 1.0)
    several = tmp_path / "s.tif"
    tifffile.imwrite(several, np.zeros((4, 8, 8)), photometric="minisblack")
    with pytest.raises(TerrainError, match=r"several images \(got 4\)"):
        Terrain.from_file(several, 1.0)
    integers = tmp_path / "i.tif"
    tifffile.imwrite(integers, np.arange(12, dtype=np.uint16).reshape(3, 4))
    assert Terrain.from_file(integers, 1.0).height(3.0, 2.0) == pytest.approx(11.0)


def test_npz_names_spacing_and_origin(tmp_path):
    path = tmp_path / "a.npz"
    np.savez(path, z=Z, other=np.zeros((2, 2)), spacing=0.2, origin=[1.0, 2.0])
    terrain = Terrain.from_file(path)
    assert terrain.extent == pytest.approx((1.0, 2.0, 2.0, 2.6))
    assert Terrain.from_file(path, 0.1, (0.0, 0.0)).extent == pytest.approx((0.0, 0.5, 0.0, 0.3))
    np.savez(path, heights=Z, spacing=[0.2])
    assert Terrain.from_file(path).height(0.0, 0.0) == pytest.approx(Z[0, 0])
    np.savez(path, a=Z, b=Z)
    with pytest.raises(TerrainError, match=r"no array `z`, .*a \(4, 6\), b \(4, 6\).*name the heights `z`"):
        Terrain.from_file(path, 1.0)
    np.savez(path, z=Z, spacing=[0.2, 0.3])
    with pytest.raises(TerrainError, match="spacing: is not one number"):
        Terrain.from_file(path)
    np.savez(path, z=Z, spacing=0.2, origin=3.0)
    with pytest.raises(TerrainError, match="the origin must be two numbers"):
        Terrain.from_file(path)


@pytest.mark.parametrize("delimiter", [",", ";", "\t", " ", ", "])
def test_delimited_text(tmp_path, delimiter):
    path = tmp_path / "a.csv"
    lines = [delimiter.join(f"{v:.3f}" for v in row) for row in Z]
    path.write_text("\ufeff# heights\n\n" + "\n".join(lines) + "  # last\n", encoding="utf-8")
    assert Terrain.from_file(path, 1.0).height(5.0, 3.0) == pytest.approx(Z[3, 5])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1,2,3\n4,x,6\n", "a.csv: line 2, column 2: not a number (got 'x')"),
        ("x,y,z\n4,5,6\n", "a.csv: line 1, column 1: not a number (got 'x'); a map holds heights only"),
        ("1,2,3\n4,5\n", "a.csv: line 2: has 2 numbers where the first row has 3"),
        ("# nothing\n", "a.csv: holds no numbers"),
        ("1,2,3\n4,nan,6\n7,8,nan", "the map holds NaN in 2 of 9 cells, the first at row 1, column 1"),
        ("1,2\n3,4\n", "the map of 2 x 2 nodes is too small; interpolation 'smooth' needs at least 3 x 3"),
    ],
)
def test_bad_text(tmp_path, text, message):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(TerrainError) as caught:
        Terrain.from_file(path, 1.0)
    assert message in str(caught.value)
    assert caught.value.file == str(path)


@pytest.mark.parametrize("name", ["a.tif", "a.npy", "a.npz", "a.csv"])
@pytest.mark.parametrize("content", [b"", b"\x00\xff\xfe garbage \x80", b"II*\x00\xff\xff\x00\x00"])
def test_damaged_files(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(TerrainError) as caught:
        Terrain.from_file(path, 1.0)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_python_objects_are_not_loaded(tmp_path):
    path = tmp_path / "a.npy"
    np.save(path, np.array([{"a": 1}], dtype=object), allow_pickle=True)
    with pytest.raises(TerrainError, match=r"cannot be read as \.npy"):
        Terrain.from_file(path, 1.0)


def test_other_files(tmp_path):
    with pytest.raises(TerrainError, match=r"nope\.tif: no such file"):
        Terrain.from_file(tmp_path / "nope.tif", 1.0)
    with pytest.raises(TerrainError, match="not a file"):
        Terrain.from_file(tmp_path, 1.0)
    picture = tmp_path / "a.jpg"
    picture.write_bytes(b"x")
    with pytest.raises(
        TerrainError,
        match=r"unknown kind \(got '\.jpg'\); known: \.asc, \.csv, \.npy, \.npz, \.png, \.tif, \.tiff",
    ):
        Terrain.from_file(picture, 1.0)
    bare = tmp_path / "bare"
    bare.write_bytes(b"x")
    with pytest.raises(TerrainError, match="no suffix"):
        Terrain.from_file(bare, 1.0)


def test_a_new_format_is_one_function(tmp_path, monkeypatch):
    suffixes()
    monkeypatch.setattr(reader_registry, "_readers", dict(reader_registry._readers))

    @reader(".zzz")
    def read_zzz(path, spacing_given):
        return HeightMap(Z, 0.25, (1.0, 1.0))

    (tmp_path / "a.zzz").write_bytes(b"")
    assert ".zzz" in suffixes()
    assert Terrain.from_file(tmp_path / "a.zzz").extent == (1.0, 2.25, 1.0, 1.75)


@pytest.mark.parametrize(
    ("heights", "spacing", "options", "message"),
    [
        (Z, None, {}, "the map has no spacing"),
        (Z, 0.0, {}, "the map's spacing must be positive (got 0.0)"),
        (Z, -1, {}, "the map's spacing must be positive (got -1)"),
        (Z, "wide", {}, "the map's spacing is not a number (got 'wide')"),
        (Z, np.nan, {}, "the map's spacing is not finite (got nan)"),
        (Z, 1.0, {"origin": (0.0,)}, "the origin must be two numbers"),
        (Z, 1.0, {"origin": (0.0, np.inf)}, "the origin y is not finite"),
        (Z, 1.0, {"interpolation": "cubic"}, "unknown interpolation (got 'cubic'); known: linear, smooth"),
        (Z, 1.0, {"interpolation": "smoth"}, "did you mean 'smooth'?"),
        (Z[:2], 1.0, {}, "the map of 2 x 6 nodes is too small; interpolation 'smooth' needs at least 3 x 3"),
        (Z[:, :1], 1.0, {"interpolation": "linear"}, "interpolation 'linear' needs at least 2 x 2"),
        (Z[0], 1.0, {}, "the map is not two-dimensional (got (6,))"),
        ([["a", "b"]] * 3, 1.0, {}, "the map does not hold real numbers (got <U1)"),
        (Z + 1j, 1.0, {}, "the map does not hold real numbers (got complex128)"),
        ([[1.0, 2.0], [3.0]], 1.0, {}, "the map's rows differ in length"),
        (np.where(Z > 1e9, Z, np.inf), 1.0, {}, "the map holds infinite heights in 24 of 24 cells"),
        (np.ma.masked_less(np.ma.array(Z), 0.0), 1.0, {}, "the map holds no data (masked)"),
    ],
)
def test_bad_grids(heights, spacing, options, message):
    with pytest.raises(TerrainError) as caught:
        Terrain.from_grid(heights, spacing, **options)
    assert message in str(caught.value)
