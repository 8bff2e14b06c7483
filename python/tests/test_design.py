import json

import numpy as np
import pytest

import pyhysteron

RATES = {"heating_rate": 2.0, "cooling_rate": 0.5}


def test_the_profile_determines_every_operator(tmp_path):
    profile = pyhysteron.design((20, 80), 10, **RATES)
    assert np.nanmin(profile.excitation) == 3
    assert profile.corners == 55
    assert profile.recorded is None
    assert len(profile) == len(profile.time) == len(profile.input)
    rate = np.diff(profile.input) / np.diff(profile.time)
    assert np.isclose(rate, 2.0).sum() + np.isclose(rate, -0.5).sum() == len(rate)
    assert profile.time[-1] == profile.duration == profile.full_duration
    assert profile.legs[0][:2] == (profile.input[0], 80.0)
    profile.to_csv(tmp_path / "profile.csv")
    read = np.loadtxt(tmp_path / "profile.csv", delimiter=",", skiprows=1)
    np.testing.assert_array_equal(read[:, 1], profile.input)
    np.testing.assert_array_equal(pyhysteron.excitation(profile.input, (20, 80), 10), profile.excitation)


def test_budget_recordings_step_and_operator():
    full = pyhysteron.design((20, 80), 10, **RATES)
    short = pyhysteron.design((20, 80), 10, budget=full.duration / 2, **RATES)
    assert short.duration <= full.duration / 2 and short.corners < 55
    assert short.full_duration == full.duration
    rest = pyhysteron.design((20, 80), 10, recorded=[short.input], **RATES)
    assert np.nanmin(rest.excitation) == 3 and np.nanmin(rest.recorded) < 3
    assert rest.duration < full.duration
    assert np.diff(pyhysteron.design((20, 80), 10, step=0.1, **RATES).time).max() <= 0.1 + 1e-9
    relays = pyhysteron.design((20, 80), 10, operator="relay", **RATES)
    assert np.nanmin(relays.excitation) == 3 and relays.input[0] > full.input[0]
    nothing = pyhysteron.design((20, 80), 10, recorded=full.input, **RATES)
    assert len(nothing) == 0 and nothing.duration == 0


@pytest.mark.parametrize(
    "options, message",
    [
        ({"heating_rate": 0}, "heating rate is 0"),
        ({"cooling_rate": np.nan}, "cooling rate is NaN"),
        ({"budget": 1}, "too short for a single ring"),
        ({"step": -1}, "step is -1"),
        ({"range": (80, 20)}, "range"),
        ({"levels": 1}, "levels"),
        ({"recorded": [0.0, 1.0]}, "moves no operator"),
        ({"operator": "x"}, "`operator` is 'x'"),
    ],
)
def test_bad_options_are_named(options, message):
    with pytest.raises(ValueError, match=message):
        pyhysteron.design(**{"range": (20, 80), "levels": 10, **RATES, **options})


def heated():
    plain = json.loads(pyhysteron.Model(np.full(55, 0.1), (20, 80)).to_json())
    body = {"kind": "first-order", "ambient": 15.0, "gain": 1.0}
    body |= {"tau_heating": 4.0, "tau_cooling": 9.0}
    model = plain | {"version": 2, "thermal": body, "drive": {"min": 0.0, "max": 80.0}}
    return pyhysteron.Model.from_json(json.dumps(model))


def test_the_body_of_a_model_is_led_within_the_drives():
    profile = pyhysteron.design_heated(heated(), range=(0, 80), levels=10)
    assert 0 <= profile.input.min() and profile.input.max() <= 80
    assert np.nanmin(profile.excitation) == 3
    rates = {"heating_rate": 0.1, "cooling_rate": 0.1}
    slower = pyhysteron.design_heated(heated(), range=(0, 80), levels=10, **rates)
    assert slower.duration > profile.duration
    budget = profile.duration / 2
    assert pyhysteron.design_heated(heated(), range=(0, 80), budget=budget).duration <= budget


@pytest.mark.parametrize(
    "options, message",
    [
        ({"heating_rate": 0.1}, "both"),
        ({"heating_rate": 1e3, "cooling_rate": 0.1}, "slower rates"),
        ({"range": (-20, -10)}, "no operator"),
        ({"levels": 1}, "levels"),
    ],
)
def test_what_a_body_cannot_follow_is_named(options, message):
    with pytest.raises(ValueError, match=message):
        pyhysteron.design_heated(heated(), **{"range": (0, 80), **options})
