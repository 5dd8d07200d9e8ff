from __future__ import annotations

import base64
from io import BytesIO

import numpy as np
from PIL import Image

from flockana.report.image import png, reduced


def rgb(image):
    return np.asarray(image.convert("RGB")).astype(int)


def test_few_colours_stay_as_they_are():
    pixels = np.full((40, 40, 4), 255, dtype=np.uint8)
    colours = np.random.default_rng(0).integers(0, 252, (40, 3)).astype(np.uint8)
    pixels[np.arange(40), 7, :3] = colours // 4 * 4
    np.testing.assert_array_equal(rgb(reduced(pixels)), pixels[:, :, :3])


def test_of_many_colours_paper_stays_white_and_a_rare_one_is_not_lost():
    pixels = np.full((300, 300, 4), 255, dtype=np.uint8)
    ramp = np.linspace(0, 255, 200).astype(np.uint8)
    pixels[:200, :200, 0], pixels[:200, :200, 1], pixels[:200, :200, 2] = ramp[None], ramp[:, None], 90
    pixels[290, 290, :3] = 213, 94, 0
    image = reduced(pixels)
    found = rgb(image)
    assert len(np.unique(found.reshape(-1, 3), axis=0)) <= 256
    assert found[250, 250].tolist() == [255, 255, 255]
    assert np.abs(found[290, 290] - (213, 94, 0)).max() <= 24
    assert np.abs(found - pixels[:, :, :3]).max() <= 40


def test_a_figure_is_an_image_in_a_page():
    text = png(lambda figure: figure.subplots().plot([0.0, 1.0], [0.0, 1.0]), (4.0, 3.0))
    head, data = text.split(",")
    assert head == "data:image/png;base64"
    assert Image.open(BytesIO(base64.b64decode(data))).size == (500, 375)


def test_paper_stays_white_beside_what_is_nearly_white():
    pixels = np.full((20, 20, 4), 255, dtype=np.uint8)
    pixels[-1, -1, :3] = 253
    assert rgb(reduced(pixels))[0, 0].tolist() == [255, 255, 255]
