"""The objectives that a scenario can maximise.

Everything that depends on the objective reads its record. A new objective is a record in a file, and its name
in the line ``RECORDS`` below.
"""

from __future__ import annotations

from nullpose.objectives.custom import Custom
from nullpose.objectives.downlink import DOWNLINK
from nullpose.objectives.means import PROPORTIONAL_FAIR, SUM_RATE
from nullpose.objectives.min_sinr import MIN_SINR
from nullpose.objectives.ratios import FloatArray, IntArray, Ratios
from nullpose.objectives.record import LEAST_RATE_BPS_HZ, ObjectiveRecord, Quantity
from nullpose.objectives.relay import RELAY
from nullpose.objectives.secrecy import FRIENDLY_JAMMING, SECRECY_RATE

__all__ = [
    "LEAST_RATE_BPS_HZ",
    "RECORDS",
    "USUAL",
    "Custom",
    "FloatArray",
    "IntArray",
    "ObjectiveRecord",
    "Quantity",
    "Ratios",
]

_ALL = (MIN_SINR, SUM_RATE, PROPORTIONAL_FAIR, SECRECY_RATE, DOWNLINK, RELAY, FRIENDLY_JAMMING)
RECORDS = {record.name: record for record in _ALL}

USUAL = MIN_SINR.name
"""The objective of a scenario that names none."""
