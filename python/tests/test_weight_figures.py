"""Figures of the weights: each where its operator is, and as large as it is."""

import numpy as np
import pytest

import pyhysteron

plt = pytest.importorskip("matplotlib.pyplot")
from pyhysteron import plot  # noqa: E402
from mpl_toolkits.mplot3d import Axes3D  # noqa: E402

pytestmark = pytest.mark.usefixtures("drawn")


@pytest.mark.parametrize("kind", ["marks", "map"])
def test_weights(model, kind):
    ax = plot.weights(model, kind=kind)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("α [°C]", "β [°C]")
    if kind == "marks":
        zero, some = ax.get_lines()
        assert len(zero.get_xdata()) + len(some.get_xdata()) == 78
        assert (some.get_ydata() >= some.get_xdata()).all(), "β is upright"
        assert len(some.get_xdata()) == model.fit.weights_not_zero
    else:
        drawn = ax.collections[0].get_array().reshape(12, 12)
        np.testing.assert_array_equal(np.ma.filled(drawn, np.nan), model.weights.T)


def test_negative_weights_bear_a_dash():
    ax = plot.weights(pyhysteron.Model([1.0, -2.0, 4.0], (0, 1)), kind="map")
    dashes = ax.get_lines()[0]
    assert (dashes.get_xdata(), dashes.get_ydata()) == ([0], [1])
    plot.weights(pyhysteron.Model([0.0, 0.0, 0.0], (0, 1)), kind="map")
    with pytest.raises(ValueError, match="`kind` is 'surface': one of 'marks', 'map', 'bars' is needed"):
        plot.weights(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)), kind="surface")


def test_bars_stand_on_their_operators_as_high_as_the_weights(model, monkeypatch):
    drawn = []
    bar3d = Axes3D.bar3d
    monkeypatch.setattr(Axes3D, "bar3d", lambda ax, *bars, **style: drawn.append(bars) or bar3d(ax, *bars, **style))
    ax = plot.weights(model, kind="bars")
    x, y, bottom, width, depth, height = drawn[0]
    assert width == depth < model.plane[1] - model.plane[0] and bottom == 0
    on_plane = ~np.isnan(model.weights)
    found = np.full_like(model.weights, np.nan)
    for alpha, beta, weight in zip(x + width / 2, y + depth / 2, height):
        found[np.argmin(abs(model.plane - alpha)), np.argmin(abs(model.plane - beta))] = weight
    np.testing.assert_array_equal(found, model.weights)
    assert len(height) == on_plane.sum()
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_zlabel()) == ("α [°C]", "β [°C]", "weight [mm]")
    assert ax.get_zlim()[1] >= np.nanmax(model.weights)


@pytest.mark.parametrize("weights, low, high", [([1.0, -2.0, 4.0], -2, 4), ([0.0, 0.0, 0.0], 0, 1), ([-1.0, -2.0, -1.0], -2, 0)])
def test_bars_of_any_sign_are_within_the_axes(weights, low, high):
    bottom, top = plot.weights(pyhysteron.Model(weights, (0, 1)), kind="bars").get_zlim()
    assert bottom <= low and top >= high


def test_bars_in_axes_that_are_given(model):
    ax = plt.figure().add_subplot(projection="3d")
    assert plot.weights(model, kind="bars", ax=ax) is ax
    with pytest.raises(ValueError, match="`ax` has the projection 'rectilinear'"):
        plot.weights(model, kind="bars", ax=plt.figure().add_subplot())
