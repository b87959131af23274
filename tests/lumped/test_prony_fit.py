"""Prony series from E(s), E(t), storage and loss moduli: exact where they can be, the stated error true where not."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.special import erfcx

from lumped import BadInput, Material, NotReached, Relaxation, Scene, laws, simulate
from lumped.materials import Fidelity
from lumped.materials.dynamic_moduli import DynamicModuli
from lumped.materials.networks import fractional_zener, prony
from lumped.materials.prony_fit import PronyFit, of_dynamic, of_operational, of_samples

Array = NDArray[np.float64]
OMEGA = np.logspace(-2, 5, 36)
TIMES = np.logspace(-5, 2, 71)
SERIES = Relaxation(1.0, (3.0, 2.0, 0.5), (1e-3, 0.02, 3.0))


def fractional(alpha: float, time: Array) -> Array:
    """E_alpha(-t^alpha) by the trapezoidal rule on its spectrum of relaxation, exact to rounding."""
    u = np.linspace(-36.0 / alpha, 36.0 / alpha, 20001)
    spectrum = math.sin(math.pi * alpha) / (2.0 * math.pi * (np.cosh(alpha * u) + math.cos(math.pi * alpha)))
    with np.errstate(over="ignore", under="ignore"):
        return np.array([np.trapezoid(spectrum * np.exp(-t * np.exp(u)), u) for t in time])


def moduli_of(series: Relaxation, omega: Array) -> DynamicModuli:
    """What a rheometer without error would measure of a series at these angular frequencies, 1/s."""
    modulus = series.operational(1j * omega)
    return DynamicModuli(omega, modulus.real, modulus.imag)


def noisy(series: Relaxation, noise: float, seed: int) -> DynamicModuli:
    """Moduli at OMEGA, each with a normal relative error."""
    rng, clean = np.random.default_rng(seed), moduli_of(series, OMEGA)
    factors = 1.0 + noise * rng.normal(size=(2, OMEGA.size))
    return DynamicModuli(OMEGA, clean.storage * factors[0], clean.loss * factors[1])


def assert_same(found: Relaxation, series: Relaxation, rtol: float) -> None:
    assert found.equilibrium == pytest.approx(series.equilibrium, rel=rtol)
    assert found.moduli == pytest.approx(series.moduli, rel=rtol)
    assert found.times == pytest.approx(series.times, rel=rtol)


def test_a_series_is_recovered_from_its_own_moduli() -> None:
    fit = of_dynamic(moduli_of(SERIES, OMEGA))
    assert_same(fit.relaxation, SERIES, 1e-10)
    assert fit.max_error <= 1e-13
    assert fit.points == OMEGA.size


def test_a_series_is_recovered_from_samples_and_from_its_transform() -> None:
    assert_same(of_samples(TIMES, SERIES(TIMES)).relaxation, SERIES, 1e-9)
    assert_same(of_operational(SERIES.operational, (1e-4, 10.0)).relaxation, SERIES, 1e-7)


def test_random_series_are_recovered_in_what_they_do() -> None:
    """Times that nearly coincide leave the terms open, not the modulus."""
    rng = np.random.default_rng(3)
    for _ in range(40):
        count = rng.integers(1, 5)
        moduli, times = 10.0 ** rng.uniform(-1, 1, count), 10.0 ** rng.uniform(-4, 1, count)
        series = Relaxation(1.0, tuple(moduli), tuple(times))
        fit = of_dynamic(moduli_of(series, OMEGA))
        assert fit.max_error <= 1e-6
        np.testing.assert_allclose(fit.relaxation(TIMES), series(TIMES), rtol=max(3.0 * fit.max_error, 1e-12))


@pytest.mark.parametrize("noise", [1e-3, 1e-2])
def test_noise_is_stated_and_averaged(noise: float) -> None:
    for seed in range(10):
        fit = of_dynamic(noisy(SERIES, noise, seed))
        assert 0.5 * noise <= fit.rms_error <= 1.1 * noise  # the two parts of the modulus err less than its size
        assert fit.rms_error <= fit.max_error <= 6.0 * noise
        assert len(fit.relaxation.moduli) <= 10
        np.testing.assert_allclose(fit.relaxation(TIMES), SERIES(TIMES), rtol=2.0 * noise)


def test_a_viscosity_is_found_only_when_it_is_sought() -> None:
    voigt = moduli_of(Relaxation(2.0, (1.0,), (0.1,), 1e-3), OMEGA)
    assert of_dynamic(voigt, viscous=True).relaxation.viscosity == pytest.approx(1e-3, rel=1e-10)
    sought_in_vain = of_dynamic(voigt)
    assert sought_in_vain.relaxation.viscosity == 0.0
    assert sought_in_vain.max_error > 0.01


@pytest.mark.parametrize("omega", [0.5, 30.0, 800.0])
def test_storage_and_loss_obey_kramers_and_kronig(omega: float) -> None:
    """E'(w) - E_inf = (2 w^2/pi) int E''(x)/(x (w^2 - x^2)) dx, the principal value, of a fit to noisy data."""
    series = of_dynamic(noisy(SERIES, 1e-2, 7)).relaxation

    def loss_over(x: float) -> float:
        return float(series.operational(1j * x).imag) / x

    def far(u: float) -> float:
        return loss_over(omega * math.exp(u)) * math.exp(u) / (1.0 - math.exp(2.0 * u)) / omega

    def near(x: float) -> float:
        return -loss_over(x) / (x + omega)

    whole = (
        quad(near, 1e-12, 2.0 * omega, weight="cauchy", wvar=omega, limit=400)[0] + quad(far, math.log(2.0), 25.0)[0]
    )
    storage = series.equilibrium + 2.0 * omega**2 / math.pi * whole
    assert storage == pytest.approx(float(series.operational(1j * omega).real), rel=1e-6)


def test_moduli_of_no_passive_material_are_not_fitted_in_silence() -> None:
    """A loss without the rise of the storage that belongs to it, pi/2 dE'/d(ln w) = E''."""
    fit = of_dynamic(DynamicModuli(OMEGA, np.full(OMEGA.size, 1.0), np.full(OMEGA.size, 0.5)))
    assert fit.max_error > 0.3


@pytest.mark.family
@pytest.mark.parametrize(
    ("alpha", "ratio", "tolerance"), [(0.1, 5.0, 1e-4), (0.5, 10.0, 1e-6), (0.8, 1.5, 1e-7), (0.3, 1e4, 1e-5)]
)
def test_stated_error_of_the_fractional_solid_covers_the_true_one(alpha: float, ratio: float, tolerance: float) -> None:
    series = fractional_zener.of(1.0, ratio, 1.0, alpha, accuracy=tolerance)
    assert series.fidelity is not None
    assert series.fidelity.inside <= tolerance
    times = np.geomspace(*series.fidelity.window, 397)
    truth = 1.0 + (ratio - 1.0) * fractional(alpha, times)
    deviation = np.abs(series(times) / truth - 1.0)
    assert 0.5 * series.fidelity.inside <= deviation.max() <= series.fidelity.inside
    assert min(series.moduli) > 0.0
    assert (series.glassy, series.relaxed) == pytest.approx((ratio, 1.0), rel=tolerance)


@pytest.mark.tenth
def test_stated_errors_cover_the_true_ones_of_random_fractional_solids() -> None:
    rng = np.random.default_rng(11)
    for _ in range(10):
        alpha, ratio, accuracy = rng.uniform(0.1, 0.9), 10.0 ** rng.uniform(0.1, 4.0), 10.0 ** rng.uniform(-7.0, -3.0)
        shortest = 10.0 ** rng.uniform(-6.0, -2.0)
        series = fractional_zener.of(1.0, ratio, 1.0, alpha, (shortest, shortest * 1e5), accuracy)
        fidelity = series.fidelity
        assert fidelity is not None
        assert fidelity.inside <= accuracy
        edges = (1e-8 * shortest, *fidelity.window, 1e6 * fidelity.window[1])
        bounds = (fidelity.before, fidelity.inside, fidelity.after)
        for (low, high), bound in zip(pairwise(edges), bounds, strict=True):
            times = np.geomspace(low, high, 101)
            truth = 1.0 + (ratio - 1.0) * fractional(alpha, times)
            assert np.abs(series(times) / truth - 1.0).max() <= max(bound, fidelity.inside)


def test_deviation_outside_of_the_window_is_bounded() -> None:
    series = fractional_zener.of(1e6, 1e7, 0.01, 0.5, window=(1e-5, 1.0), accuracy=1e-4)
    fidelity = series.fidelity
    assert fidelity is not None
    for times, bound in ((np.logspace(-12, -5, 50), fidelity.before), (np.logspace(0, 6, 50), fidelity.after)):
        truth = 1e6 + 9e6 * erfcx(np.sqrt(times / 0.01))
        deviation = np.abs(series(times) / truth - 1.0).max()
        assert fidelity.inside < deviation <= bound < 0.6


def test_branches_stay_few() -> None:
    """Of 1e-4 over eight decades, and of 1e-6 over nine."""
    assert len(fractional_zener.of(1.0, 10.0, 1.0, 0.5, window=(1e-4, 1e4), accuracy=1e-4).moduli) <= 20
    assert len(fractional_zener.of(1.0, 10.0, 1.0, 0.5).moduli) <= 40


def test_a_power_law_is_fitted_in_its_window() -> None:
    fit = of_operational(lambda s: math.sqrt(math.pi) * s**0.5, (1e-3, 10.0), 1e-5)
    times = np.geomspace(1e-3, 10.0, 173)
    assert np.abs(fit.relaxation(times) * np.sqrt(times) - 1.0).max() <= fit.max_error <= 1e-5
    assert fit.relaxation.fidelity == Fidelity((1e-3, 10.0), fit.max_error)


def test_a_viscosity_passes_by_the_series() -> None:
    series = Relaxation(2.0, (3.0,), (1e-2,), 0.1)
    fit = of_operational(series.operational, (1e-3, 0.1), 1e-8, viscosity=0.1)
    assert_same(fit.relaxation, series, 1e-8)
    assert fit.relaxation.viscosity == 0.1


def test_few_samples_are_met_with_what_they_can_tell() -> None:
    times = np.array([1e-3, 1e-2, 0.1, 1.0])
    fit = of_samples(times, SERIES(times))
    deviation = np.abs(fit.relaxation(times) / SERIES(times) - 1.0)
    assert fit.max_error == pytest.approx(deviation.max(), abs=1e-14)
    assert fit.max_error <= 1e-6


def test_an_elastic_material_has_no_terms() -> None:
    for relaxed in (None, 5.0):
        fit = of_operational(lambda s: 5.0 + 0.0 * s, (0.1, 10.0), relaxed=relaxed)
        assert fit.relaxation.moduli == ()
        assert fit.relaxation.equilibrium == pytest.approx(5.0, rel=1e-12)


def test_what_does_not_decay_is_not_reached() -> None:
    with pytest.raises(NotReached, match="reached"):
        of_operational(lambda s: 1.0 + s / (s + 1.0) ** 2, (1e-2, 10.0))


@pytest.mark.tenth
def test_fractional_solid_is_a_material_of_every_law() -> None:
    material = {"law": "fractional_zener", "E_inf": 0.6e6, "E_glass": 6e6, "tau": 0.01, "alpha": 0.4, "nu": 0.45}
    scene = Scene.load("polymer-sphere", {"target.material": material})
    ting, mdr = (simulate(laws.get(name).of(scene), scene, 1e-4) for name in ("ting", "mdr"))
    assert ting.quantities["restitution"].value == pytest.approx(mdr.quantities["restitution"].value, abs=1e-6)
    coarse = Scene.load("polymer-sphere", {"target.material": material | {"accuracy": 1e-3}})
    other = simulate(laws.mdr.of(coarse), coarse, 1e-5).quantities["peak_force"].value
    assert other == pytest.approx(mdr.quantities["peak_force"].value, rel=1e-3)


def measured_scene(folder: Path, header: str = "frequency_Hz") -> Path:
    """A scene file beside what a rheometer would measure of the packaged polymer, 1e-2 to 1e4 Hz."""
    data = moduli_of(Scene.load("polymer-sphere").geometry.material.young, 2.0 * math.pi * np.logspace(-2, 4, 61))
    rows = np.column_stack([data.omega / (2.0 * math.pi), data.storage, data.loss])
    np.savetxt(folder / "moduli.csv", rows, delimiter=",", header=f"{header},storage_Pa,loss_Pa", comments="")
    path = folder / "measured.toml"
    path.write_text(
        "[striker]\nshape = 'sphere'\nradius = 0.006\nmass = 0.05\nvelocity = 0.02\n[target]\nshape = 'half_space'\n"
        "[target.material]\nlaw = 'measured'\nfile = 'moduli.csv'\nnu = 0.45\n"
    )
    return path


def test_a_scene_names_the_moduli_measured_beside_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "elsewhere").mkdir()
    path = measured_scene(tmp_path)
    monkeypatch.chdir(tmp_path / "elsewhere")
    scene, known = Scene.load(path), Scene.load("polymer-sphere")
    found, exact = (simulate(laws.ting.of(each), each, 1e-7) for each in (scene, known))
    for name in ("peak_force", "duration", "restitution"):
        assert found.quantities[name].value == pytest.approx(exact.quantities[name].value, rel=1e-5), name
    (series,) = (entry for entry in found.model_ledger if entry.effect == "material series")
    assert series.treated.startswith("fitted to ")
    assert Scene.from_dict(scene.to_dict()).geometry.material.young == scene.geometry.material.young


def test_a_table_of_moduli_that_cannot_be_used_is_named(tmp_path: Path) -> None:
    path = measured_scene(tmp_path, header="frequency")
    with pytest.raises(BadInput, match=r"moduli.csv: frequency_Hz: missing column; accepted"):
        Scene.load(path)
    with pytest.raises(BadInput, match=r"nowhere.csv: cannot be read"):
        Scene.load(path, {"target.material.file": "nowhere.csv"})
    with pytest.raises(BadInput, match=r"target.material.file: 3 is not accepted; accepted: the name of a file"):
        Scene.load(path, {"target.material.file": 3})


def test_a_fit_travels_with_the_table_of_its_material() -> None:
    known = fractional_zener.of(1e6, 2e6, 0.01, 0.5)
    table = Material(known, 0.3).to_dict()
    kept = {key: tuple(value) if isinstance(value, list) else value for key, value in table.items()}
    again = prony.of(**{key: kept[key] for key in kept if key in prony.MEMBER.sets[0]})
    assert again == known


def test_bound_of_the_force_is_that_of_the_ages_it_meets() -> None:
    fidelity = Fidelity((1e-3, 1.0), 1e-6, 0.1, 0.2)
    assert fidelity.of_force(2.0) == 0.2
    assert fidelity.of_force(0.0) == fidelity.of_force(1e-3) == pytest.approx(0.1, rel=1e-4)
    assert fidelity.of_force(0.5) == pytest.approx(1e-6 + 0.1 * 3e-3 / 0.5)
    assert Fidelity((1e-3, 1.0), 1e-6).of_force(0.5) == math.inf


def test_a_csv_of_either_frequency_is_read(tmp_path: Path) -> None:
    data = moduli_of(SERIES, OMEGA)
    fits: list[PronyFit] = []
    for header, turns in (("frequency_Hz", 2.0 * math.pi), ("angular_frequency_rad_per_s", 1.0)):
        path = tmp_path / f"{header}.csv"
        rows = np.column_stack([data.omega / turns, data.storage, data.loss])
        np.savetxt(path, rows, fmt="%.17g", delimiter=",", header=f"{header},storage_Pa,loss_Pa", comments="")
        fits.append(of_dynamic(DynamicModuli.read_csv(path)))
    for fit in fits:
        assert_same(fit.relaxation, SERIES, 1e-10)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("frequency_Hz,storage_Pa\n1,2\n2,3\n", "loss_Pa"),
        ("hertz,storage_Pa,loss_Pa\n1,2,3\n2,3,4\n", "frequency_Hz"),
        ("frequency_Hz,angular_frequency_rad_per_s,storage_Pa,loss_Pa\n1,6,2,3\n2,12,3,4\n", "not both"),
        ("frequency_Hz,storage_Pa,loss_Pa\n1,2,x\n2,3,4\n", "loss_Pa"),
        ("frequency_Hz,storage_Pa,loss_Pa\n0,2,3\n2,3,4\n", "frequency_Hz: "),
        ("frequency_Hz,storage_Pa,loss_Pa\n1,-2,3\n2,3,4\n", "storage_Pa: "),
        ("frequency_Hz,storage_Pa,loss_Pa\n1,2,-3\n2,3,4\n", "loss_Pa: "),
        ("frequency_Hz,storage_Pa,loss_Pa\n2,2,3\n2,3,4\n", "twice"),
        ("frequency_Hz,storage_Pa,loss_Pa\n2,2,3\n", "two rows"),
    ],
)
def test_bad_data_are_refused_by_name(tmp_path: Path, text: str, named: str) -> None:
    path = tmp_path / "moduli.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(BadInput, match=named):
        DynamicModuli.read_csv(path)


def test_every_fault_of_the_data_is_named() -> None:
    with pytest.raises(BadInput) as refused:
        DynamicModuli(np.array([1.0, -2.0]), np.array([0.0, 1.0]), np.array([math.nan, -1.0]))
    assert [fault.key for fault in refused.value.faults] == ["loss", "omega", "storage", "loss"]
    with pytest.raises(BadInput, match="cannot be read"):
        DynamicModuli.read_csv(Path("unreadable.csv"))


def test_arguments_out_of_range_are_refused() -> None:
    for window, tolerance, key in [
        ((1.0, 1.0), 1e-6, "window"),
        ((0.0, 1.0), 1e-6, "window"),
        ((0.1, 1.0), 0.0, "tolerance"),
    ]:
        with pytest.raises(BadInput, match=key):
            of_operational(SERIES.operational, window, tolerance)
    with pytest.raises(BadInput, match="relaxed"):
        of_operational(SERIES.operational, (0.1, 1.0), relaxed=-1.0)
    with pytest.raises(BadInput, match="not above the error"):
        of_operational(lambda s: -1.0 + 0.0 * s, (0.1, 1.0))
    for times, moduli, key in [
        ([1.0, -1.0], [1.0, 1.0], "times"),
        ([1.0, 2.0], [1.0], "times"),
        ([1.0, 2.0], [1.0, 0.0], "moduli"),
    ]:
        with pytest.raises(BadInput, match=key):
            of_samples(times, moduli)


@pytest.mark.family
@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"E_glass": 1.0}, "E_glass"),
        ({"window": (1.0,)}, "window"),
        ({"window": (2.0, 1.0)}, "window"),
        ({"alpha": 0.95, "E_glass": 1e9, "accuracy": 1e-8}, "looser accuracy"),
    ],
)
def test_fractional_solids_that_cannot_be_are_refused(values: dict[str, object], named: str) -> None:
    with pytest.raises(ValueError, match=named):
        fractional_zener.of(**{"E_inf": 1.0, "E_glass": 10.0, "tau": 1.0, "alpha": 0.5} | values)  # type: ignore[arg-type]


def test_what_a_series_says_of_its_fit_is_checked() -> None:
    with pytest.raises(ValueError, match="belong together"):
        prony.of(1.0, fit_window=(1.0, 2.0))
    with pytest.raises(BadInput, match="fit_window"):
        Fidelity((2.0, 1.0), 1e-6)
    with pytest.raises(BadInput, match="fit_error"):
        Fidelity((1.0, 2.0), -1e-6)
    with pytest.raises(BadInput, match="fit_error"):
        Fidelity((1.0, 2.0), 1e-6, 0.1, math.nan)
