# The public interface: each name stands here once, and is imported at its first use.

from . import objective as objective, plot as plot
from .certificate.verify import verify as verify
from .errors import (
    Fault as Fault,
    NullposeError as NullposeError,
    OutputError as OutputError,
    ScenarioError as ScenarioError,
    SolveError as SolveError,
    UsageError as UsageError,
    WrongTypeError as WrongTypeError,
)
from .physics import (
    Link as Link,
    Pose as Pose,
    Poses as Poses,
    evaluate as evaluate,
    min_margin as min_margin,
    min_secrecy_rate as min_secrecy_rate,
    min_sinr as min_sinr,
    pose_frames as pose_frames,
)
from .scenario import (
    Airframe as Airframe,
    Airspace as Airspace,
    Antenna as Antenna,
    Array as Array,
    Destination as Destination,
    Eavesdropper as Eavesdropper,
    Jammer as Jammer,
    Node as Node,
    NoFlyZone as NoFlyZone,
    Origin as Origin,
    Receiver as Receiver,
    Scenario as Scenario,
    Transmitter as Transmitter,
    apply_overrides as apply_overrides,
    json_schema as json_schema,
    load as load,
)
from .solver import (
    ErrorSizes as ErrorSizes,
    ManySolutions as ManySolutions,
    Result as Result,
    Scheme as Scheme,
    Status as Status,
    Tracker as Tracker,
    compare as compare,
    sensitivity as sensitivity,
    solve as solve,
    solve_many as solve_many,
)
from .solver.certificate_from_proof import certificate_of as certificate_of
from .solver.robust import guarantee as guarantee
from .solver.trajectory import (
    Trajectory as Trajectory,
    solve_trajectory as solve_trajectory,
)
from .studio.exports import (
    show as show,
)
from .study import (
    ResultTable as ResultTable,
    compare_airframes as compare_airframes,
    evaluate_against as evaluate_against,
    least_tilt as least_tilt,
    poses_from_csv as poses_from_csv,
    sweep as sweep,
    value_map as value_map,
)

__version__: str
