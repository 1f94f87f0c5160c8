"""Other solvers of the five-dimensional problem, one file each. To add one: README.md in the folder above."""

from benchmarks.peers.cma_es import CmaEs
from benchmarks.peers.differential_evolution import DifferentialEvolution
from benchmarks.peers.direct import Direct
from benchmarks.peers.dual_annealing import DualAnnealing
from benchmarks.peers.five_pose import FivePose
from benchmarks.peers.multistart_slsqp import MultistartSlsqp
from benchmarks.peers.peer import Answer, Budget, Peer
from benchmarks.peers.shgo import Shgo

PEERS: tuple[Peer, ...] = (
    MultistartSlsqp(),
    DualAnnealing(),
    DifferentialEvolution(),
    Direct(share=10),
    Direct(),
    Shgo(),
    CmaEs(),
)

GENERAL_PURPOSE = frozenset(peer.name for peer in PEERS if peer.general_purpose)
TAILORED = frozenset(peer.name for peer in PEERS if not peer.general_purpose)

__all__ = ["GENERAL_PURPOSE", "PEERS", "TAILORED", "Answer", "Budget", "FivePose", "Peer"]
