"""Controllers, simulated plants and tuning."""

import json
import pickle

import numpy as np
import pytest
from common import together

import pyhysteron
from pyhysteron.control import Controller, Pid, RelayTest

INTERVAL = 0.01
REFERENCE = 36 - 20 * np.cos(0.02 * np.arange(1500)) * np.cos(0.0031 * np.arange(1500))


class Stage:
    """A motor on a spring, and what went over the wire."""

    def __init__(self):
        self.mm, self.written, self.passed = 0.0, [], 0.0

    def read(self):
        return self.mm

    def write(self, volts):
        self.written.append(volts)
        self.mm += 0.1 * (0.5 * volts - self.mm)


@pytest.fixture(scope="module")
def identified():
    """A model of the simulated actuator, as good as a least-squares fit on a coarse plane makes it."""
    plant, volts, output = pyhysteron.PreisachPlant(), [], []
    for n in range(4000):
        plant.write(75 - (75 - 0.015 * n) * np.cos(0.05 * n))
        plant.advance(INTERVAL)
        volts.append(plant.truth()[1])
        output.append(plant.truth()[0])
    start = pyhysteron.Model(np.full(55, 2.0), (8, 150), offset=float(output[0]))
    return pyhysteron.adapt(start, volts, output, method="least-squares", forgetting=1.0).model


def controller(model=None, **options):
    plant = pyhysteron.PreisachPlant()
    options = {"pid": Pid(0.2, integral_s=0.05), "filter_s": 0.01, "tolerance": 0.5, **options}
    return Controller(INTERVAL, plant.drives, model=model, **options)


def error(trace, start=300):
    return np.sqrt(np.mean((trace.output - trace.reference)[start:] ** 2))


def test_all_schemes_track(identified):
    plain = Controller(INTERVAL, (0, 150), pid=Pid(0.2, integral_s=0.05), filter_s=0.01)
    schemes = {
        "pid": plain,
        "inverse": controller(identified, pid=None),
        "inverse-pid": controller(identified),
        "anticipate": controller(identified, policy="anticipate"),
        "adaptive": controller(pyhysteron.Adaptive(identified, method="least-squares")),
    }
    errors = {name: error(scheme.run(pyhysteron.PreisachPlant(), REFERENCE)) for name, scheme in schemes.items()}
    assert errors["adaptive"] < errors["inverse-pid"] < errors["inverse"] < errors["pid"] < 10.0
    assert schemes["adaptive"].adaptive.model() != identified
    assert schemes["inverse-pid"].adaptive is None


def test_a_shift_is_followed_in_the_loop(identified):
    """The model believes a plane that lies 8 V lower than the plant's."""
    low, high = identified.range
    shifted = pyhysteron.Model(identified.weights, (low - 8, high - 8), offset=identified.offset)
    fixed = controller(shifted, pid=None)
    following = controller(pyhysteron.AdaptiveLoad(shifted), pid=None)
    still = error(fixed.run(pyhysteron.PreisachPlant(), REFERENCE), 800)
    assert error(following.run(pyhysteron.PreisachPlant(), REFERENCE), 800) < 0.5 * still
    assert isinstance(following.adaptive, pyhysteron.AdaptiveLoad)
    assert abs(following.adaptive.shift - 8) < 4
    with pytest.raises(TypeError, match="AdaptiveLoad is needed"):
        controller("model.json")


def test_a_run_tells_what_is_ahead():
    """A wire heats before the output is due, only if it is told; with `run` as in a loop of `step`."""
    plain = json.loads(pyhysteron.Model(np.full(36, 0.1), (25, 75), input="drive").to_json())
    body = {"kind": "first-order", "ambient": 20.0, "gain": 80.0, "tau_heating": 1.0, "tau_cooling": 1.0}
    model = plain | {"version": 2, "thermal": body, "drive": {"min": 0.0, "max": 1.0}}
    model = pyhysteron.Model.from_json(json.dumps(model))

    class Wire:
        def __init__(self):
            self.state, self.output, self.drives = model.start(), 0.0, []

        def read(self):
            return self.output

        def write(self, drive):
            self.output = self.state.step(drive, dt=0.1)
            self.drives.append(drive)

    target = np.repeat([0.5, 3.0], 30)
    drives = {}
    for ahead in (0, 20):
        wire, loop = Wire(), Controller(0.1, (0, 1), model=model)
        loop.run(wire, target, ahead=ahead)
        drives[ahead] = np.array(wire.drives)
        wire, loop = Wire(), Controller(0.1, (0, 1), model=model)
        for n, output in enumerate(target):
            # `run` always tells the target that is due when the drive acts, one sample later.
            told = target[n + 1 : n + 1 + max(ahead, 1)]
            wire.write(loop.step(output, wire.read(), ahead=told).drive)
        assert np.array_equal(drives[ahead], wire.drives)
    # The drive of sample 29 is the first that aims at the step of sample 30 without being told more.
    assert np.max(drives[20][:29]) > np.max(drives[0][5:29])
    with pytest.raises((OverflowError, TypeError)):
        loop.run(Wire(), target, ahead=-1)


def test_run_is_the_loop_written_out(identified):
    trace = controller(identified, policy="anticipate").run(pyhysteron.PreisachPlant(), REFERENCE)
    plant, own = pyhysteron.PreisachPlant(), controller(identified, policy="anticipate")
    headings = pyhysteron.control.headings(REFERENCE, 0.5)
    for n, target in enumerate(REFERENCE):
        assert plant.truth()[0] == trace.output[n]
        # The inverse aims at the target that is due when the drive acts, one sample later.
        due = min(n + 1, len(REFERENCE) - 1)
        told = REFERENCE[n + 1 : n + 2]
        action = own.step(target, *plant.read(), heading=headings[due], ahead=told)
        assert (action.command, action.drive) == (trace.command[n], trace.drive[n])
        plant.write(action.drive)
        plant.advance(INTERVAL)
    assert len(trace) == len(REFERENCE)
    assert np.array_equal(trace.reference, REFERENCE)
    assert np.array_equal(trace.time, INTERVAL * np.arange(len(REFERENCE)))


def test_a_device_of_ones_own_is_tracked():
    pid = Pid(2.0, integral_s=0.1)
    stage = Stage()
    trace = Controller(INTERVAL, (0, 10), pid=pid).run(stage, np.full(500, 3.0))
    assert abs(stage.mm - 3.0) < 1e-3
    assert np.array_equal(trace.drive, stage.written)
    assert np.array_equal(trace.output, trace.measured)


def test_a_device_that_is_a_wrapped_plant_gives_the_same_run(identified):
    class Wrapped:
        def __init__(self):
            self.plant = pyhysteron.PreisachPlant()
            self.read, self.write, self.advance = self.plant.read, self.plant.write, self.plant.advance

    whole = controller(identified).run(pyhysteron.PreisachPlant(), REFERENCE)
    wrapped = controller(identified).run(Wrapped(), REFERENCE)
    assert np.array_equal(whole.drive, wrapped.drive)
    assert np.array_equal(whole.measured, wrapped.measured)


@pytest.mark.parametrize("error", [OSError("unplugged"), KeyboardInterrupt()])
@pytest.mark.parametrize(
    "limits, rest", [((-5.0, 5.0), 0.0), ((1.0, 5.0), 1.0), ((-5.0, -1.0), -1.0)]
)
def test_what_a_device_raises_is_raised_and_the_drive_is_at_rest(error, limits, rest):
    class Broken(Stage):
        def read(self):
            if len(self.written) == 3:
                raise error
            return super().read()

    stage = Broken()
    with pytest.raises(type(error)):
        Controller(INTERVAL, limits, pid=Pid(2.0)).run(stage, REFERENCE)
    assert len(stage.written) == 4
    assert stage.written[-1] == rest


@pytest.mark.parametrize("read", [None, (None, None), (np.nan, None), np.float32(1.0), 1])
def test_readings_that_are_taken(read):
    class Device(Stage):
        def read(self):
            return read

    trace = controller().run(Device(), [1.0, 2.0])
    assert np.isfinite(trace.drive).all()
    assert trace.sensor_fault.tolist() == [not isinstance(read, (int, np.float32))] * 2


def test_readings_that_are_refused():
    class Device(Stage):
        def read(self):
            return "warm"

    with pytest.raises(TypeError, match=r"`device.read\(\)` gave warm"):
        controller().run(Device(), [1.0])
    for device in (3, object()):
        with pytest.raises(TypeError, match=r"`device` is .*: an object with read\(\) and write\(drive\) is needed"):
            controller().run(device, [1.0])
    with pytest.raises(ValueError, match="simulated plants only"):
        controller().run(Stage(), [1.0], events=[{"at_s": 0, "load_n": 3}])


def test_events_reach_the_plant():
    calm = controller().run(pyhysteron.PreisachPlant(), np.full(400, 40.0))
    events = [{"at_s": 2.0, "load_n": 10.0}, {"at_s": 1.0, "lost": True}, {"at_s": 1.5, "lost": False}]
    moved = controller().run(pyhysteron.PreisachPlant(), np.full(400, 40.0), events=events)
    assert np.array_equal(calm.output[:100], moved.output[:100])
    assert np.isnan(moved.measured[100:150]).all() and moved.sensor_fault[100:150].all()
    assert not np.isnan(moved.measured[150:]).any()
    assert abs(moved.output[200] - moved.output[199]) > 5.0
    for events, error, text in [
        ([{"at_s": 0, "room_degc": 30.0}], pyhysteron.RigError, "no room"),
        ([{"at_s": 0, "load_n": 99.0}], pyhysteron.RigError, "load"),
        ([{"at_s": -1.0, "load_n": 9.0}], ValueError, "'at_s' is -1"),
        ([{"load_n": 9.0}], ValueError, "at_s"),
        ([{"at_s": 0, "weight": 9.0}], TypeError, "unknown field `weight`"),
    ]:
        with pytest.raises(error, match=text):
            controller().run(pyhysteron.PreisachPlant(), [1.0], events=events)


def test_snapshots_of_what_was_learned(identified):
    adaptive = pyhysteron.Adaptive(identified)
    loop = controller(adaptive)
    trace = loop.run(pyhysteron.PreisachPlant(), REFERENCE)
    assert trace.adapted.any() and len(trace.snapshots) > 10
    last = trace.snapshots[-1]
    assert np.array_equal(last.weights, loop.adaptive.weights, equal_nan=True)
    assert last.offset == loop.adaptive.offset
    assert adaptive.model().offset == identified.offset, "the one that was given has learned"


def test_a_trace_becomes_a_frame_and_a_file(tmp_path):
    pandas = pytest.importorskip("pandas")
    trace = controller().run(pyhysteron.PreisachPlant(), REFERENCE[:50])
    frame = pandas.DataFrame(trace.to_dict())
    trace.to_csv(tmp_path / "run.csv")
    read = pandas.read_csv(tmp_path / "run.csv")
    assert np.array_equal(read["drive"], frame["drive"])
    assert list(read.columns[1:]) == list(frame.columns[1:])


def test_the_spring_with_a_loop_around_its_temperature():
    plant = pyhysteron.SpringPlant()
    inner = Pid(0.1, integral_s=8.0)
    loop = Controller(0.2, (24, 92), drives=plant.drives, inner=inner, square_root=True, filter_s=0.6)
    for _ in range(600):
        action = loop.step_command(60.0, *plant.read())
        plant.write(action.drive)
        plant.advance(0.2)
    assert abs(plant.truth()[1] - 60.0) < 2.0
    assert plant.quantities == ["current [A]", "temperature [degC]", "displacement [mm]"]


def test_plants_are_labelled_and_repeat_themselves():
    for plant in [pyhysteron.SpringPlant, pyhysteron.PreisachPlant]:
        assert plant().simulated is True and "simulated" in repr(plant())
        assert isinstance(plant(), pyhysteron.SimulatedPlant)
        first, second, third = plant(seed=4), plant(seed=4), plant(seed=5)
        assert first.read() == second.read() != third.read()
        with pytest.raises(TypeError, match="cannot pickle"):
            pickle.dumps(first)
    assert pyhysteron.PreisachPlant().read()[1] is None
    assert pyhysteron.PreisachPlant(measure_input=True).read()[1] is not None
    with pytest.raises(TypeError):
        pyhysteron.SimulatedPlant()


@pytest.mark.parametrize(
    ("make", "error", "text"),
    [
        (lambda: pyhysteron.SpringPlant(load_n=12.0), pyhysteron.RigError, "load (N) is 12, but must lie between 0 and 11"),
        (lambda: pyhysteron.SpringPlant(load=6.0), TypeError, "unknown field `load`"),
        (lambda: pyhysteron.SpringPlant(load_n="six"), ValueError, "SpringPlant: invalid type"),
        (lambda: pyhysteron.SpringPlant(load_n=np.nan), ValueError, "SpringPlant: every number must be finite"),
        (lambda: pyhysteron.SpringPlant(load_n=object()), TypeError, "SpringPlant"),
        (lambda: pyhysteron.SpringPlant(lvdt={"dropout": 2}), pyhysteron.RigError, "dropout"),
        (lambda: pyhysteron.PreisachPlant(seed=-1), ValueError, "PreisachPlant: invalid value"),
        (lambda: pyhysteron.PreisachPlant(levels=3), pyhysteron.RigError, "levels of the cloud"),
        (lambda: pyhysteron.PreisachPlant().disturb(room_degc=3), pyhysteron.RigError, "no room"),
        (lambda: pyhysteron.SpringPlant().disturb(weight=3), TypeError, "unknown field `weight`"),
        (lambda: Pid(np.nan), pyhysteron.ControlError, "a finite gain"),
        (lambda: Pid(1.0, integral_s=-1), pyhysteron.ControlError, "times from zero"),
        (lambda: Pid(1.0).step(1.0, 0.0), ValueError, "`dt` is 0"),
        (lambda: Pid(1.0).step(1.0, 0.1, limits=(1, 0)), ValueError, "`limits` are 1 and 0"),
        (lambda: Controller(0.0, (0, 1)), pyhysteron.ControlError, "`interval_s`"),
        (lambda: Controller(0.1, (1, 0)), pyhysteron.ControlError, "`commands`"),
        (lambda: Controller(0.1, (0, 1), drives=(0, np.inf)), pyhysteron.ControlError, "`drives`"),
        (lambda: Controller(0.1, (0, 1), stuck_s=0), pyhysteron.ControlError, "`stuck_s`"),
        (lambda: Controller(0.1, (0, 1), policy="sleep"), ValueError, "`policy` is 'sleep'"),
        (lambda: Controller(0.1, (0, 1), model=3), TypeError, "`model` is 3: a Model, an Adaptive or an AdaptiveLoad"),
        (lambda: Controller(0.1, (0, 1), model=pyhysteron.Model([1, -1, 1], (0, 1))), pyhysteron.CoreError, ""),
        (lambda: controller().step(np.nan, 0.0), pyhysteron.CoreError, "`target`"),
        (lambda: controller().step(1.0, 0.0, heading="up"), ValueError, "`heading` is 'up'"),
        (lambda: controller().step_command(np.inf, 0.0), pyhysteron.CoreError, "`command`"),
        (lambda: controller().run(Stage(), [1.0, np.nan]), pyhysteron.CoreError, "`reference[1]`"),
        (lambda: RelayTest((1, 0), 0.5), pyhysteron.ControlError, "`commands`"),
        (lambda: RelayTest((0, 1), 0.5, hysteresis=-1), pyhysteron.ControlError, "`hysteresis`"),
        (lambda: RelayTest((0, 1), 0.5).gains(0.1), ValueError, "not done"),
        (lambda: Pid.from_step(np.zeros(100), 50, 1.0, 0.1), ValueError, "does not answer"),
    ],
)
def test_what_is_refused(make, error, text):
    with pytest.raises(error) as raised:
        make()
    assert text in str(raised.value)


def test_pid_by_hand():
    pid = Pid(2.0, integral_s=4.0)
    assert pid.step(1.0, 0.5) == 2.0 + 0.25
    assert pid.step(-1.0, 0.5, bias=10.0) == 10.0 - 2.0 + 0.0
    assert pid.hold(bias=1.0) == -1.0
    assert pid.relax(4.0, bias=1.0) == 1.0 - 1.0  # half of the way to an empty integral
    assert pid.hold(bias=1.0) == 0.0
    pid.reset()
    assert pid.step(1.0, 0.5, limits=(-1, 1)) == 1.0
    assert repr(pid) == "Pid(2, integral_s=4, derivative_s=0)"
    assert (pid.gain, pid.integral_s, pid.derivative_s) == (2.0, 4.0, 0.0)


def test_a_relay_test_tunes_a_loop_that_tracks():
    plant, test = pyhysteron.PreisachPlant(), RelayTest((40, 110), 36.0, hysteresis=0.5)
    assert test.outputs is None and test.oscillation(INTERVAL) is None
    for _ in range(10_000):
        if test.done:
            break
        plant.write(test.command)
        plant.advance(INTERVAL)
        test.push(plant.read()[0])
    gain, period = test.oscillation(INTERVAL)
    pid = test.gains(INTERVAL)
    assert pid.gain == pytest.approx(gain / 3.2) and pid.integral_s == pytest.approx(2.2 * period)
    loop = Controller(INTERVAL, (0, 150), pid=pid, filter_s=0.01)
    assert error(loop.run(pyhysteron.PreisachPlant(), REFERENCE)) < 2.0


def test_threads_may_share_a_controller_and_a_plant(identified):
    loop, plant = controller(identified), pyhysteron.PreisachPlant(levels=60)

    def work(_):
        for n in range(5):
            loop.run(plant, REFERENCE[:100])
            plant.write(loop.step(30.0 + n, *plant.read()).drive)
            plant.advance(INTERVAL)

    together(work)
