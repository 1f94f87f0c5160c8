"""The paper's claims, each checked against what the solver finds."""

from nullpose.report.claims.check import CLAIM_COUNT, check_claims
from nullpose.report.claims.claim import Claim, Verdict
from nullpose.report.claims.study import JammingStudy
from nullpose.report.claims.text import claims_json, claims_markdown

__all__ = [
    "CLAIM_COUNT",
    "Claim",
    "JammingStudy",
    "Verdict",
    "check_claims",
    "claims_json",
    "claims_markdown",
]
