"""What a certificate is about, and whether that is a given scenario."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from nullpose.certificate.certificate import Certificate
from nullpose.certificate.file import scenario_digest
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario


def subject(certificate: Certificate) -> dict[str, Any]:
    """Return what a certificate is about as plain data: its claim, its scenario and the scenario's digest.

    Args:
        certificate: any.
    """
    scenario = certificate.scenario.to_dict()
    return {
        "name": certificate.scenario.name,
        "scenario_sha256": scenario_digest(scenario),
        "scheme": certificate.scheme,
        "null_jammer": certificate.null_jammer,
        "value": certificate.value,
        "upper_bound": certificate.upper_bound,
        "antenna": certificate.scenario.antenna_record.label,
        "scenario": scenario,
    }


def differences(certificate: Certificate, scenario: Scenario) -> tuple[str, ...]:
    """Return where a scenario differs from a certificate's; empty if the claim is about it as well.

    Names do not count, nor does it matter in which unit a power is stated: what counts are the ratios, the
    positions and the axes that are allowed.

    Args:
        certificate: with its scenario.
        scenario: another.
    """
    if _problem(certificate.scenario) == _problem(scenario):
        return ()
    its, mine = dict(_values(certificate.scenario.to_dict())), dict(_values(scenario.to_dict()))
    return tuple(
        f"{path}: the certificate has {its.get(path, 'nothing')}, the scenario {mine.get(path, 'nothing')}"
        for path in {**its, **mine}
        if its.get(path) != mine.get(path)
    )


def _problem(scenario: Scenario) -> tuple[object, ...]:
    airframe = scenario.airframe
    reach = None if airframe is None else (airframe.tilt_max_rad, airframe.mount_rad)
    return build_family(scenario).digest, scenario.objective, scenario.axis_band, reach


def _values(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _values(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list | tuple) and any(isinstance(inner, dict) for inner in value):
        for index, inner in enumerate(value):
            yield from _values(inner, f"{path}[{index}]")
    else:
        yield path, value
