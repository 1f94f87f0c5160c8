"""The short dipole (paper eq. 1.2), whose null is perfect."""

from nullpose.antenna.quadratic import QuadraticAntenna

__all__ = ["SHORT_DIPOLE"]

SHORT_DIPOLE = QuadraticAntenna(name="dipole", label="short dipole", leak=0.0)
