"""Export to C and to functional mock-up units: what the command writes, from Python."""

import zipfile

import numpy as np
import pytest

import pyhysteron

MODEL = pyhysteron.Model(np.full(15, 0.5), (20, 80), input="temperature [degC]", output="displacement [mm]")


@pytest.mark.parametrize("real", ["float", "double"])
def test_c(tmp_path, real):
    export = MODEL.export_c(tmp_path, real=real, name="wire")
    assert export.name == "wire" and export.inverse is True
    assert export.flash_bytes > 0 and export.ram_bytes > 0 and export.step_loop == 13
    assert all(file.exists() for file in export.files)
    learns = MODEL.export_c(tmp_path, real=real, name="wire", adaptation=True)
    assert {file.name for file in learns.files} > {"hysteron_mcu_adapt.c", "hysteron_mcu_adapt.h"}
    assert f"typedef {real} hys_real;" in (tmp_path / "hysteron_mcu.h").read_text()


def test_a_loop_with_gate_filter_and_measured_time(tmp_path):
    plain = MODEL.export_c(tmp_path, name="wire", controller=True, dt=0.05)
    assert plain.controller_bytes > 0
    assert MODEL.export_c(tmp_path / "alone", name="wire").controller_bytes is None
    gains = pyhysteron.control.Pid(0.25, integral_s=2.0)
    more = {"gains": gains, "gate": 0.5, "filter_s": 0.125, "measured_dt": True}
    full = MODEL.export_c(tmp_path, name="wire", controller=True, dt=0.05, drive_range=(25, 75), **more)
    assert full.controller_bytes > plain.controller_bytes
    assert {file.name for file in full.files} > {"hysteron_mcu_gate.c", "hysteron_mcu_filter.h"}
    assert "0.25f" in (tmp_path / "wire.c").read_text()
    assert "hys_controller_step_after" in (tmp_path / "hysteron_mcu_control.h").read_text()
    for name, value in more.items():
        with pytest.raises(ValueError, match=name):
            MODEL.export_c(tmp_path, **{name: value})
    with pytest.raises(ValueError, match="`dt`"):
        MODEL.export_c(tmp_path, controller=True)


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("inverse", [False, True])
def test_fmu(tmp_path, fmi, inverse):
    path = tmp_path / "wire.fmu"
    made = MODEL.export_fmu(path, inverse=inverse, fmi=fmi)
    assert made.name == ("sf_Inverse_MKP" if inverse else "sf_MKP") and made.bytes == path.stat().st_size
    description = zipfile.ZipFile(path).read("modelDescription.xml").decode()
    assert f'fmiVersion="{fmi}.0"' in description
    assert all(f'name="{name}"' in description for name in made.inputs + made.outputs)


def test_fmu_of_a_controller(tmp_path):
    path = tmp_path / "loop.fmu"
    plain = MODEL.export_fmu(path, controller=True, dt=0.05)
    assert plain.name == "sf_Controller_MKP" and plain.inputs[1] == "measured"
    description = zipfile.ZipFile(path).read("modelDescription.xml").decode()
    assert 'stepSize="0.05"' in description
    more = dict(gains=pyhysteron.control.Pid(1.0, integral_s=2.0), gate=0.1, filter_s=0.2, drive_range=(25, 75))
    full = MODEL.export_fmu(path, controller=True, dt=0.05, **more)
    assert full.token != plain.token
    description = zipfile.ZipFile(path).read("modelDescription.xml").decode()
    assert all(f'start="{value}' in description for value in (25, 75))
    for wrong in (dict(controller=True), dict(gate=0.1), dict(dt=0.05), dict(drive_range=(0, 1)),
                  dict(controller=True, dt=0.05, inverse=True)):
        with pytest.raises(ValueError, match="controller"):
            MODEL.export_fmu(tmp_path / "none.fmu", **wrong)
    assert not (tmp_path / "none.fmu").exists()


def test_what_is_refused(tmp_path):
    with pytest.raises(pyhysteron.ExportError, match="cannot be the model's name in C"):
        MODEL.export_c(tmp_path, name="3d")
    with pytest.raises(ValueError, match="`real` is 'half': one of 'float', 'double'"):
        MODEL.export_c(tmp_path, real="half")
    with pytest.raises(pyhysteron.ExportError, match="end with .fmu"):
        MODEL.export_fmu(tmp_path / "wire.zip")
    with pytest.raises(ValueError, match="`fmi` is 1: 2 or 3"):
        MODEL.export_fmu(tmp_path / "wire.fmu", fmi=1)
    with pytest.raises(pyhysteron.CoreError):
        pyhysteron.Model([1.0, -1.0, 1.0], (0, 1)).export_fmu(tmp_path / "wire.fmu", inverse=True)
    assert not list(tmp_path.glob("*.fmu"))
    with pytest.raises(OSError):
        MODEL.export_fmu(tmp_path / "nowhere" / "wire.fmu")
