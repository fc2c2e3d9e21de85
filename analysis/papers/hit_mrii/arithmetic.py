"""Eq. 42: relative errors from the numbers that the text prints."""

from __future__ import annotations

from rover_pin.analysis.locomotion import relative_error
from rover_pin.analysis.papers.finding import Finding, claimed, compared

PRINTED = (
    ("Task 1, time", 153.82, 182.92, 18.92),
    ("Task 2, way ahead", 6422.75, 4727.74, 26.39),
    ("Task 2, way across", 1363.75, 978.18, 28.27),
    ("Task 5, time", 17.47, 18.21, 4.24),
    ("Task 5, way", 437.75, 43.65, 90.03),
)
"""What, commanded, real, printed error in percent."""

HALF_DIGIT = 0.005

CREEP_TIMES = (0.12, 0.07, 0.75, 1.24, 0.43, 0.22, 0.51, 0.21, 0.27, 0.69)
CREEP_HEIGHTS = (14.03, 32.7, 31.21, 23.37, 26.76)


def findings() -> list[Finding]:
    """One row a printed error, then what two of them imply."""
    rows = [
        compared(what, "%", printed, 100.0 * relative_error([asked], [real]), within=HALF_DIGIT,
                 where="eq. 42", why="the formula on the printed numbers")
        for what, asked, real, printed in PRINTED
    ]  # fmt: skip
    lift = sum(CREEP_HEIGHTS) / 0.1774 / 5.0
    phase = sum(CREEP_TIMES) / 0.0089 / 10.0
    rows.append(
        claimed(
            "Task 4: lift of a creep that its five errors and 17.74 % come from", "mm", "not printed", lift,
            True, where="eq. 42", used=True, why="used as the lift of Tasks 4 and 5",
        )
    )  # fmt: skip
    rows.append(
        claimed(
            "Task 4: time of a phase that its ten errors and 0.89 % come from", "s", "not printed", phase,
            abs(phase * 3.6 - lift) < 0.3 * lift, where="eq. 42", at_most="partly",
            why=f"at 3.6 mm/s that is {3.6 * phase:.0f} mm, not the {lift:.0f} mm that the heights give",
        )
    )  # fmt: skip
    return rows
