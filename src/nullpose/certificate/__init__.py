"""Certificates: what a proof claims, as a file, and a verifier that imports nothing from the solver."""

from nullpose.certificate.certificate import Certificate, Leaves, Tree, claimed_axes
from nullpose.certificate.file import certificate_text, parse_certificate, read_certificate, write_certificate
from nullpose.certificate.subject import differences, subject
from nullpose.certificate.verify import Verdict, verify

__all__ = [
    "Certificate",
    "Leaves",
    "Tree",
    "Verdict",
    "certificate_text",
    "claimed_axes",
    "differences",
    "parse_certificate",
    "read_certificate",
    "subject",
    "verify",
    "write_certificate",
]
