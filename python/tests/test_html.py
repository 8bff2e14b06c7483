"""What a notebook shows of models, recordings and fits."""

import xml.etree.ElementTree as xml

import numpy as np
import pytest

import pyhysteron

SVG = "{http://www.w3.org/2000/svg}"


def page(thing):
    """The pictures and the text; well-formed."""
    root = xml.fromstring(thing._repr_html_())
    return root.findall(f"{SVG}svg"), " ".join(root.itertext())


def test_model(model):
    pictures, text = page(model)
    assert [picture.find(f"{SVG}title").text.split()[0] for picture in pictures] == ["output", "weights"]
    assert "mkp, 12 levels" in text and "temperature [°C]" in text and "RMSE" in text
    points = pictures[0].find(f".//{SVG}polyline").get("points").split()
    assert len(points) > 100
    loop = np.array([point.split(",") for point in points], float)
    assert (loop >= 0).all() and (loop <= 150).all()


def test_recording(recording):
    pictures, text = page(recording)
    assert len(pictures) == 2 and "3000, measured" in text and "lift [mm]" in text
    assert len(pictures[1].findall(f".//{SVG}g/{SVG}rect")) == 78


def test_fit(recording):
    fit = pyhysteron.fit(recording, levels="auto", bootstrap=0).fit
    pictures, text = page(fit)
    assert len(pictures[0].findall(f".//{SVG}circle")) == len(fit.validation.scores)
    assert "cross-validation" in text
    assert page(pyhysteron.fit(recording, levels=5, smooth=0.0, bootstrap=0).fit)[0] == []


@pytest.mark.parametrize(
    "thing",
    [
        pyhysteron.Model([1.0, -2.0, 4.0], (0, 1), input="a < b & c [<]", output="\"'", operator="relay", sign=-1),
        pyhysteron.Model(np.zeros(3), (0, 1)),
        pyhysteron.Model(np.ones(100 * 101 // 2), (0, 1)),
        pyhysteron.Recording([1.0, 1.0], [2.0, 2.0], input_name="<x>"),
        pyhysteron.Recording([1.0], [2.0]),
        pyhysteron.Recording([-1e120, 1e120, 0.0], [-1e120, 1e120, 0.0]),
        pyhysteron.Recording(np.arange(3.0), np.arange(3.0), time=[0, 1, 2], load=[1, 1, 1], simulated=True),
    ],
    ids=str,
)
def test_odd_ones(thing):
    page(thing)


def test_it_stays_small():
    input = np.sin(np.linspace(0, 500, 400_000))
    recording = pyhysteron.Recording(input, input)
    assert len(recording._repr_html_()) < 60_000
    assert len(pyhysteron.Model(np.ones(100 * 101 // 2), (0, 1))._repr_html_()) < 60_000


def test_thermal_and_load(recording, swings):
    time = 0.1 * np.arange(len(swings))
    body = pyhysteron.fit((swings / 100) ** 2, recording.output, time=time, levels=5, thermal="first-order", bootstrap=0)
    assert "thermal body" in page(body)[1]
    loads = [pyhysteron.Recording(swings, (9 - load) * swings, load=np.full(len(swings), load)) for load in (3.0, 6.0)]
    assert "3 to 6" in page(pyhysteron.fit(loads, levels=5, bootstrap=0))[1]
