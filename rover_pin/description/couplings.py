"""All couplings of a rover: the URDF's mimics and the sidecar's, each once and none against another."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from rover_pin.description.mimic import Mimic
from rover_pin.description.notes import Notes
from rover_pin.errors import SidecarError
from rover_pin.mechanism import CouplingSpec


def gather_couplings(
    mimics: Iterable[Mimic],
    stated: Iterable[CouplingSpec],
    held: Mapping[str, float],
    notes: Notes,
    file: object,
) -> list[CouplingSpec]:
    """Mimics first, then the sidecar's; joints that limits hold go to the right-hand side.

    Raises:
        SidecarError: two couplings of the same two joints that differ, or pairs that close a circle and
            contradict each other on the way round.
    """
    found: list[CouplingSpec] = []
    for spec in [*map(as_coupling, mimics), *stated]:
        free = _without_held(spec, held, file)
        if free is None:
            notes.add(f"coupling {spec.name}: all its joints are held by their limits; dropped")
            continue
        twin = next((other for other in found if set(other.joints) == set(free.joints)), None)
        if twin is not None and _same(twin, free):
            notes.add(f"coupling {spec.name} says the same as {twin.name}; counted once")
            continue
        if twin is not None and len(free.joints) <= 2:
            raise SidecarError(
                f"couples the same joints as {twin.name}, but differently",
                file=file,
                element=f"couplings.{free.name}",
                value=" and ".join(map(_shown, (twin, free))),
                cure="keep one",
            )
        found.append(free)
    _refuse_circles(found, file)
    return found


def as_coupling(mimic: Mimic) -> CouplingSpec:
    """A mimic as the coupling it is."""
    joints = (
        {mimic.joint: 1.0} if mimic.multiplier == 0.0 else {mimic.joint: 1.0, mimic.of: -mimic.multiplier}
    )
    return CouplingSpec(name=f"mimic_{mimic.joint}", joints=joints, offset=mimic.offset)


def _without_held(spec: CouplingSpec, held: Mapping[str, float], file: object) -> CouplingSpec | None:
    if not any(name in held for name in spec.joints):
        return spec
    offset = spec.offset - sum(c * held[name] for name, c in spec.joints.items() if name in held)
    joints = {name: c for name, c in spec.joints.items() if name not in held}
    if joints:
        return CouplingSpec(name=spec.name, joints=joints, offset=offset)
    if abs(offset) > 1e-6:
        raise SidecarError(
            f"the limits that hold its joints contradict it, residual {offset:.6g}",
            file=file,
            element=f"couplings.{spec.name}",
            cure="open the limits or drop the coupling",
        )
    return None


def _same(a: CouplingSpec, b: CouplingSpec) -> bool:
    name = next(iter(a.joints))
    ratio = b.joints[name] / a.joints[name]
    pairs = [(a.joints[n] * ratio, b.joints[n]) for n in a.joints] + [(a.offset * ratio, b.offset)]
    return all(math.isclose(x, y, rel_tol=1e-9, abs_tol=1e-9 * abs(b.joints[name])) for x, y in pairs)


def _shown(spec: CouplingSpec) -> str:
    return " + ".join(f"{c:g} {name}" for name, c in spec.joints.items()) + f" = {spec.offset:g}"


def _refuse_circles(specs: Sequence[CouplingSpec], file: object) -> None:
    """Walk the couplings of two joints: each says b = ratio a + shift; round a circle, a must be a again."""
    edges: dict[str, list[tuple[str, float, float, str]]] = {}
    for spec in specs:
        if len(spec.joints) == 2:
            (a, ca), (b, cb) = spec.joints.items()
            edges.setdefault(a, []).append((b, -ca / cb, spec.offset / cb, spec.name))
            edges.setdefault(b, []).append((a, -cb / ca, spec.offset / ca, spec.name))
    reached: dict[str, tuple[float, float, tuple[str, ...]]] = {}
    for start in edges:
        if start in reached:
            continue
        reached[start] = (1.0, 0.0, (start,))
        stack = [start]
        while stack:
            here = stack.pop()
            scale, shift, path = reached[here]
            for other, ratio, offset, name in edges[here]:
                there = (ratio * scale, ratio * shift + offset)
                if other not in reached:
                    reached[other] = (*there, (*path, other))
                    stack.append(other)
                    continue
                known = reached[other]
                size = max(abs(known[0]), abs(there[0]), 1e-300)
                if abs(known[0] - there[0]) > 1e-9 * size or abs(known[1] - there[1]) > 1e-9:
                    circle = " -> ".join([*path, other])
                    raise SidecarError(
                        f"a coupling cycle that contradicts itself: {circle}",
                        file=file,
                        element=f"couplings.{name}",
                        cure="drop one of its couplings, or make their ratios agree",
                    )
