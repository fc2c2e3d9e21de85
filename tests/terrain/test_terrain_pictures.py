"""Height maps as grey pictures and as ESRI ASCII grids."""

import numpy as np
import pytest
from PIL import Image

from rover_pin.errors import TerrainError
from rover_pin.terrain import Terrain

LEVELS = np.random.default_rng(3).integers(0, 60000, (4, 6))

ASC = """ncols 4
nrows 3
xllcorner 100.0
yllcorner -20.5
cellsize 0.5
NODATA_value -9999
1 2 3 4
5 6 7 8
9 10 11 12
"""


def grid(tmp_path, text=ASC, name="a.asc"):
    path = tmp_path / name
    path.write_text(text)
    return path


def refused(path, *args, **keywords):
    with pytest.raises(TerrainError) as caught:
        Terrain.from_file(path, *args, **keywords)
    return str(caught.value).replace(f"{path.parent}/", "")


def test_a_16_bit_picture_in_metres_a_level(tmp_path):
    path = tmp_path / "a.png"
    Image.fromarray(LEVELS.astype(np.uint16)).save(path)
    terrain = Terrain.from_file(path, 0.5, height_scale=1e-4, height_offset=-2.0)
    i, j = np.indices(LEVELS.shape)
    np.testing.assert_allclose(terrain.height(0.5 * j, 0.5 * i), 1e-4 * LEVELS - 2.0, atol=1e-12)
    assert Terrain.parse(str(path), 0.5, "smooth", 1e-4, -2.0).digest == terrain.digest


def test_an_8_bit_picture(tmp_path):
    path = tmp_path / "a.png"
    Image.fromarray((LEVELS % 256).astype(np.uint8)).save(path)
    terrain = Terrain.from_file(path, 1.0, height_scale=0.01)
    assert terrain.height(5.0, 3.0) == pytest.approx(0.01 * (LEVELS[3, 5] % 256))


def test_a_picture_needs_its_scale(tmp_path):
    path = tmp_path / "a.png"
    Image.fromarray(LEVELS.astype(np.uint16)).save(path)
    assert refused(path, 0.5) == (
        "a.png: a picture does not say how high a grey level is (got '16 bits: 0 to 65535'); "
        "give the metres a level: --height-scale (and --height-offset), or height_scale="
    )
    assert refused(path, height_scale=0.1) == (
        "a.png: the map has no spacing; give the metres from node to node: --spacing, or spacing="
    )
    assert refused(path, 0.5, height_scale=0.0) == "a.png: the height scale must not be zero (got 0.0)"
    assert refused(path, 0.5, height_scale=np.nan) == "a.png: the height scale is not finite (got nan)"
    assert refused(path, 0.5, height_scale=1, height_offset=np.inf) == (
        "a.png: the height offset is not finite (got inf)"
    )


@pytest.mark.parametrize(
    ("mode", "told"),
    [("RGB", "colours, RGB"), ("P", "a palette"), ("LA", "grey with transparency"), ("1", "black and white")],
)
def test_pictures_of_another_sort(tmp_path, mode, told):
    path = tmp_path / "a.png"
    Image.fromarray((LEVELS % 256).astype(np.uint8)).convert(mode).save(path)
    assert refused(path, 1.0, height_scale=1.0) == (
        f"a.png: is not a picture of one grey level a pixel (got '{told}'); "
        "export heights as greyscale, best of 16 bits"
    )


@pytest.mark.parametrize("keep", [0, 4, 20, 33, 60, 90])
def test_damaged_pictures(tmp_path, keep):
    path = tmp_path / "a.png"
    Image.fromarray(LEVELS.astype(np.uint16)).save(path)
    path.write_bytes(path.read_bytes()[:keep])
    told = refused(path, 1.0, height_scale=1.0)
    assert told.startswith("a.png: cannot be read as PNG (got ")
    assert "\n" not in told


def test_a_scale_for_other_files(tmp_path):
    path = tmp_path / "a.npy"
    np.save(path, LEVELS)
    assert Terrain.from_file(path, 1.0, height_scale=0.5).height(2.0, 1.0) == pytest.approx(LEVELS[1, 2] / 2)
    with pytest.raises(TerrainError, match="only a file has a height scale"):
        Terrain.parse("flat", height_scale=1.0)


def test_the_last_row_of_a_grid_lies_south(tmp_path):
    terrain = Terrain.from_file(grid(tmp_path))
    assert terrain.spacing == 0.5
    assert terrain.extent == (100.25, 101.75, -20.25, -19.25)  # centres of the outer cells
    assert terrain.height(100.25, -20.25) == pytest.approx(9.0)
    assert terrain.height(101.75, -19.25) == pytest.approx(4.0)
    centred = ASC.replace("corner", "center").replace("-9999\n1", "-1\n1")
    assert Terrain.from_file(grid(tmp_path, centred)).extent == (100.0, 101.5, -20.5, -19.5)
    assert Terrain.from_file(grid(tmp_path), 0.1, (0, 0)).extent == pytest.approx((0.0, 0.3, 0.0, 0.2))


def test_a_grid_may_break_its_lines_anywhere_and_say_little(tmp_path):
    text = "NROWS 3\nNCOLS 4\nCELLSIZE 2\n" + "\n".join(str(v) for v in range(12))
    terrain = Terrain.from_file(grid(tmp_path, text))
    assert terrain.extent == (1.0, 7.0, 1.0, 5.0)
    assert terrain.height(1.0, 5.0) == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("7 8", "-9999 8", "the map holds no data (NODATA_value -9999) in 1 of 12 cells, "
         "the first at row 1, column 2; fill them or cut them off"),
        ("NODATA_value -9999\n1 2", "1 -9999", "the map holds no data (NODATA_value -9999) in 1 of 12 cells, "
         "the first at row 0, column 1; fill them or cut them off"),
        ("-9999\n1", "nan\nnan", "the map holds no data (NODATA_value nan) in 1 of 12 cells, "
         "the first at row 0, column 0; fill them or cut them off"),
        ("cellsize 0.5\n", "", "cellsize: missing; write `cellsize NUMBER` above the heights"),
        ("cellsize 0.5", "cellsize -1", "cellsize: must be positive (got -1.0)"),
        ("cellsize 0.5", "celsize 0.5", "line 5: unknown key (got 'celsize'); "
         "did you mean 'cellsize' or 'ncols'?"),
        ("nrows 3", "nrows 4", "holds 12 heights where nrows x ncols is 16; "
         "mend the header, or fetch the whole file"),
        ("nrows 3", "nrows 2.5", "nrows: not a whole number above zero (got 2.5)"),
        ("nrows 3", "nrows 3\nnrows 3", "line 3, nrows: stands twice; keep one"),
        ("nrows 3", "nrows three", "line 2, nrows: not a number (got 'three'); write a number"),
        ("6 7", "6 7,5", "line 8, column 3: not a number (got '7,5'); "
         "write a point for the decimal mark"),
        ("6 7", "6 1_7", "line 8, column 3: not a number (got '1_7'); write a number"),
        ("6 7", "6 1e300", "the map holds heights beyond 1e+09 m in 1 of 12 cells, "
         "the first at row 1, column 2; fill them or cut them off"),
        ("cellsize 0.5", "dx 0.5\ndy 0.4", "dx, dy: cells that are not square (got '0.5 x 0.4'); "
         "resample to square cells"),
        ("cellsize 0.5", "cellsize 0.5\nxllcenter 2", "xllcorner: both the corner and the centre of the "
         "first cell are given; keep one"),
    ],
)  # fmt: skip
def test_grids_that_cannot_be_used(tmp_path, old, new, told):
    assert refused(grid(tmp_path, ASC.replace(old, new))) == f"a.asc: {told}"


@pytest.mark.parametrize("content", [b"", b"\x00\xff\xfe garbage", b"\x89PNG\r\n\x1a\n"])
def test_damaged_grids(tmp_path, content):
    path = tmp_path / "a.asc"
    path.write_bytes(content)
    told = refused(path)
    assert told.startswith("a.asc: ")
    assert "\n" not in told
