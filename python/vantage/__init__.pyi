# SPDX-License-Identifier: Apache-2.0
# Types of the module, written by packaging/write_stub.py; shapes, units and errors are in the docstrings.
import os
from typing import Any, Callable, Dict, Iterable, List, Literal, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

__version__: str

# A point (x, y, z): survey frame, metres.
Vec3 = Tuple[float, float, float]
# The same where it is given: any three numbers.
Point = Union[Sequence[float], npt.NDArray[Any]]
# A file or a folder.
Path = Union[str, os.PathLike[str]]
# Called with the share done, in [0, 1], now and then; the call ends early if it returns False.
Progress = Callable[[float], Any]
# Heads as an array (n, 3): survey frame, metres; or stations with their set-ups; or stations that were placed.
Stations = Union[npt.ArrayLike, Sequence[Station], Sequence[PlacedStation]]
# A region seen from above, survey frame: points inside an odd number of its rings of corners (x, y).
Rings = Sequence[Sequence[Tuple[float, float]]]
# An array; docstrings tell its shape.
Floats = npt.NDArray[np.float64]
# Value of a setting, in the form of the option of that name: a number, a text, a truth value, or a sequence of them.
Setting = Union[None, bool, float, Path, Sequence[Any]]

class Error(RuntimeError):
    code: Literal["invalid_argument", "io", "malformed_file", "no_suitable_device", "out_of_memory", "device_failure"]
    details: Tuple[str, ...]

class MeshInfo:
    @property
    def name(self) -> str: ...
    @property
    def role(self) -> Literal["surveyed", "blocking", "search", "ignore"]: ...
    @property
    def diffuse(self) -> float: ...
    @property
    def triangle_count(self) -> int: ...
    @property
    def weight(self) -> int: ...
    @property
    def door(self) -> bool: ...
    @property
    def station_area(self) -> bool: ...
    @property
    def glass(self) -> bool: ...
    @property
    def mirror(self) -> bool: ...
    @property
    def detail_m(self) -> float: ...
    @property
    def accuracy_m(self) -> float: ...

class Room:
    @property
    def name(self) -> str: ...
    @property
    def storey(self) -> str: ...
    @property
    def floor_m2(self) -> float: ...
    @property
    def box(self) -> Floats: ...
    @property
    def outline(self) -> List[Floats]: ...

class Scene:
    @staticmethod
    def load(
        file: Path,
        *,
        surveyed: Sequence[str] = [],
        blocking: Sequence[str] = [],
        search: Sequence[str] = [],
        ignore: Sequence[str] = [],
        weights: Sequence[Tuple[str, int]] = [],
        details_mm: Sequence[Tuple[str, float]] = [],
        accuracies_mm: Sequence[Tuple[str, float]] = [],
        doors: Sequence[str] = [],
        station_area: Sequence[str] = [],
        glass: Sequence[str] = [],
        mirror: Sequence[str] = [],
        scene_index: Optional[int] = None,
        default_diffuse: float = 0.5,
        unit: Optional[Literal["m", "cm", "mm", "in", "ft"]] = None,
        up: Optional[Literal["x", "y", "z"]] = None,
        beside: Sequence[str] = [],
        wall_layers: Sequence[str] = [],
        wall_height_m: Optional[float] = None,
        shared_meshes: Literal["auto", "always", "never"] = "auto",
        max_memory_bytes: int = 0,
        allow_outside: bool = False,
    ) -> Scene: ...
    @staticmethod
    def from_triangles(positions: npt.ArrayLike, triangles: npt.NDArray[Any], diffuse: float = 0.5) -> Scene: ...
    def with_changes(
        self,
        *,
        move: Mapping[str, Any] = {},
        remove: Sequence[str] = [],
        add: Sequence[Mapping[str, Any]] = (),
    ) -> Scene: ...
    @property
    def bounds(self) -> Floats: ...
    @property
    def meshes(self) -> List[MeshInfo]: ...
    @property
    def rooms(self) -> List[Room]: ...
    @property
    def triangle_count(self) -> int: ...
    @property
    def has_search_area(self) -> bool: ...
    @property
    def notes(self) -> List[str]: ...
    @property
    def defaults(self) -> Dict[str, Any]: ...
    @property
    def fingerprint(self) -> int: ...

class SceneBuilder:
    def __init__(self) -> None: ...
    def add(
        self,
        positions: npt.ArrayLike,
        triangles: npt.NDArray[Any],
        *,
        name: str = "mesh",
        role: Optional[Literal["surveyed", "blocking", "search", "ignore"]] = None,
        diffuse: float = 0.5,
        weight: int = 1,
        door: bool = False,
        station_area: bool = False,
        detail_m: float = 0.0,
        accuracy_m: float = 0.0,
        colour: Sequence[float] = [1.0, 1.0, 1.0, 1.0],
        translation: Point = (0.0, 0.0, 0.0),
        rotation: Sequence[float] = [0.0, 0.0, 0.0, 1.0],
    ) -> int: ...
    def replace(
        self,
        mesh: int,
        positions: npt.ArrayLike,
        triangles: npt.NDArray[Any],
        *,
        name: str = "mesh",
        role: Optional[Literal["surveyed", "blocking", "search", "ignore"]] = None,
        diffuse: float = 0.5,
        weight: int = 1,
        door: bool = False,
        station_area: bool = False,
        detail_m: float = 0.0,
        accuracy_m: float = 0.0,
        colour: Sequence[float] = [1.0, 1.0, 1.0, 1.0],
        translation: Point = (0.0, 0.0, 0.0),
        rotation: Sequence[float] = [0.0, 0.0, 0.0, 1.0],
    ) -> None: ...
    def move(
        self,
        mesh: int,
        translation: Point = (0.0, 0.0, 0.0),
        rotation: Sequence[float] = [0.0, 0.0, 0.0, 1.0],
    ) -> None: ...
    def build(self) -> Scene: ...
    @property
    def rebuilt_all(self) -> bool: ...
    def __len__(self) -> int: ...

def load_gltf(
    bytes: bytes,
    name: str = "glTF in memory",
    *,
    surveyed: Sequence[str] = [],
    blocking: Sequence[str] = [],
    search: Sequence[str] = [],
    ignore: Sequence[str] = [],
    weights: Sequence[Tuple[str, int]] = [],
    details_mm: Sequence[Tuple[str, float]] = [],
    accuracies_mm: Sequence[Tuple[str, float]] = [],
    doors: Sequence[str] = [],
    station_area: Sequence[str] = [],
    glass: Sequence[str] = [],
    mirror: Sequence[str] = [],
    scene_index: Optional[int] = None,
    default_diffuse: float = 0.5,
    unit: Optional[Literal["m", "cm", "mm", "in", "ft"]] = None,
    up: Optional[Literal["x", "y", "z"]] = None,
    beside: Sequence[str] = [],
    wall_layers: Sequence[str] = [],
    wall_height_m: Optional[float] = None,
    shared_meshes: Literal["auto", "always", "never"] = "auto",
    max_memory_bytes: int = 0,
    allow_outside: bool = False,
) -> Scene: ...
def built_in_scene_names() -> List[str]: ...
def write_built_in_scene(name: str, file: Path, triangles: int = 0) -> None: ...

class Scanner:
    def __init__(
        self,
        *,
        name: str = "custom",
        heading_deg: float = 0.0,
        horizontal_angle_deg: float = 360.0,
        vertical_angle_deg: float = 300.0,
        zenith_start_deg: float = 0.0,
        azimuth_step_deg: float = 0.1,
        zenith_step_deg: float = 0.1,
        row_zeniths_deg: Optional[npt.ArrayLike] = None,
        directions_deg: Optional[npt.ArrayLike] = None,
        times_s: Optional[npt.ArrayLike] = None,
        height_m: float = 1.85,
        min_range_m: float = 0.1,
        max_range_m: float = 130.0,
        points_per_second: float = 1000000.0,
        battery_min: float = 0.0,
        battery_scans: float = 0.0,
        noise: Optional[Dict[str, npt.ArrayLike]] = None,
        beam_divergence_mrad: float = 0.0,
        exit_diameter_mm: float = 0.0,
        angle_accuracy_arcsec: float = 0.0,
        range_accuracy_mm: float = 0.0,
        range_accuracy_ppm: float = 0.0,
        tilt_accuracy_arcsec: float = 0.0,
        detection_range_m: float = 0.0,
        detection_reflectivity: float = 0.9,
        dropout: float = 0.0,
    ) -> None: ...
    @staticmethod
    def load(name: str, more: Path = "") -> Scanner: ...
    @property
    def rows(self) -> int: ...
    @property
    def columns(self) -> int: ...
    @property
    def rays(self) -> int: ...
    def check(self) -> None: ...
    def to_dict(self) -> Dict[str, Any]: ...
    name: str
    heading_deg: float
    horizontal_angle_deg: float
    vertical_angle_deg: float
    zenith_start_deg: float
    azimuth_step_deg: float
    zenith_step_deg: float
    @property
    def row_zeniths_deg(self) -> Optional[Floats]: ...
    @row_zeniths_deg.setter
    def row_zeniths_deg(self, given: Optional[npt.ArrayLike]) -> None: ...
    @property
    def directions_deg(self) -> Optional[Floats]: ...
    @directions_deg.setter
    def directions_deg(self, given: Optional[npt.ArrayLike]) -> None: ...
    @property
    def times_s(self) -> Optional[Floats]: ...
    @times_s.setter
    def times_s(self, given: Optional[npt.ArrayLike]) -> None: ...
    height_m: float
    min_range_m: float
    max_range_m: float
    points_per_second: float
    battery_min: float
    battery_scans: float
    @property
    def noise(self) -> Optional[Dict[str, Floats]]: ...
    @noise.setter
    def noise(self, given: Optional[Dict[str, npt.ArrayLike]]) -> None: ...
    beam_divergence_mrad: float
    exit_diameter_mm: float
    angle_accuracy_arcsec: float
    range_accuracy_mm: float
    range_accuracy_ppm: float
    tilt_accuracy_arcsec: float
    detection_range_m: float
    detection_reflectivity: float
    dropout: float

class InstrumentErrors:
    def __init__(
        self,
        *,
        vertical_index_deg: float = 0.0,
        collimation_deg: float = 0.0,
        trunnion_deg: float = 0.0,
        range_offset_m: float = 0.0,
        range_scale_ppm: float = 0.0,
    ) -> None: ...
    @staticmethod
    def draw(scanner: Scanner, seed: int) -> InstrumentErrors: ...
    vertical_index_deg: float
    collimation_deg: float
    trunnion_deg: float
    range_offset_m: float
    range_scale_ppm: float

def scanners(more: Path = "") -> List[Tuple[str, str]]: ...
def load_directions(file: Path) -> Tuple[Floats, Optional[Floats]]: ...

class StationSetup:
    def __init__(self, *, heading_deg: float = 0.0, tilt_deg: float = 0.0, scanner: int = 0) -> None: ...
    @property
    def turned(self) -> bool: ...
    def survey_from_scanner(self) -> Floats: ...
    heading_deg: float
    tilt_deg: float
    scanner: int

class Station:
    def __init__(self, position: Point, setup: StationSetup = ..., active: bool = True) -> None: ...
    @property
    def position(self) -> Vec3: ...
    @position.setter
    def position(self, given: Point) -> None: ...
    setup: StationSetup
    active: bool

class PlacedStation:
    @property
    def uv(self) -> Tuple[float, float]: ...
    @property
    def position(self) -> Vec3: ...
    @property
    def ground(self) -> Vec3: ...
    @property
    def status(self) -> Literal["ok", "hole", "clash", "inside", "off_ground", "outside"]: ...
    @property
    def existing(self) -> bool: ...
    @property
    def setup(self) -> StationSetup: ...
    @property
    def active(self) -> bool: ...

def heads(stations: Sequence[PlacedStation]) -> Floats: ...

class SearchArea:
    def __init__(
        self,
        scene: Scene,
        *,
        max_slope_deg: float = 25.0,
        headroom_m: float = 2.0,
        min_area_m2: float = 0.25,
        passage_width_m: float = 0.6,
        passage_height_m: float = 1.9,
        climb_m: float = 0.25,
        enter: Sequence[Point] = [],
        enter_closed: bool = True,
        levels: Optional[Tuple[float, float]] = None,
        within: Sequence[Rings] = [],
        without: Sequence[Rings] = [],
    ) -> None: ...
    @property
    def uv_min(self) -> Tuple[float, float]: ...
    @property
    def uv_max(self) -> Tuple[float, float]: ...
    @property
    def derived(self) -> bool: ...
    @property
    def description(self) -> str: ...
    @property
    def positions(self) -> Floats: ...
    @property
    def uvs(self) -> Floats: ...
    @property
    def triangles(self) -> npt.NDArray[np.uint32]: ...
    def locate(self, uvs: npt.ArrayLike) -> Floats: ...
    def project(self, grounds: npt.ArrayLike) -> Floats: ...

class ClashChecker:
    def __init__(self, scene: Scene, *, lower_m: float = 0.6, upper_m: float = 1.35, radius_m: float = 0.5) -> None: ...
    def clashes(self, grounds: npt.ArrayLike, height_m: Optional[float] = None) -> npt.NDArray[np.bool_]: ...
    def sees(self, a: npt.ArrayLike, b: npt.ArrayLike) -> Union[bool, npt.NDArray[np.bool_]]: ...
    def distance(self, points: npt.ArrayLike, limit_m: float) -> Floats: ...

class Target:
    def __init__(self, name: str, centre: Point, control_m: float = 0.0) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def centre(self) -> Vec3: ...
    @property
    def control_m(self) -> float: ...
    @property
    def proposed(self) -> bool: ...
    @property
    def stations(self) -> List[int]: ...
    @property
    def check(self) -> bool: ...

def read_targets_csv(file: Path) -> List[Target]: ...

class OnSiteOptions:
    def __init__(
        self,
        *,
        set_up_min: float = 3.0,
        photos_min: float = 0.0,
        walking_m_per_s: float = 0.8,
        detour: float = 1.5,
        entrance: Optional[Point] = None,
        day_min: Optional[float] = None,
        crews: int = 1,
        day_start_min: float = 480.0,
        windows: Sequence[str] = [],
    ) -> None: ...
    set_up_min: float
    photos_min: float
    walking_m_per_s: float
    detour: float
    @property
    def entrance(self) -> Optional[Vec3]: ...
    @entrance.setter
    def entrance(self, given: Optional[Point]) -> None: ...
    day_min: Optional[float]
    crews: int
    day_start_min: float
    @property
    def windows(self) -> List[str]: ...
    @windows.setter
    def windows(self, given: Sequence[str]) -> None: ...

class BatteryUse:
    @property
    def instrument(self) -> str: ...
    @property
    def battery_min(self) -> float: ...
    @property
    def battery_scans(self) -> float: ...
    @property
    def on_min(self) -> float: ...
    @property
    def scans(self) -> int: ...
    @property
    def batteries(self) -> int: ...
    @property
    def in_a_day(self) -> int: ...

class Round:
    @property
    def order(self) -> List[int]: ...
    @property
    def arrive_min(self) -> List[float]: ...
    @property
    def stay_min(self) -> List[float]: ...
    @property
    def legs_m(self) -> List[float]: ...
    @property
    def paths(self) -> List[List[Vec3]]: ...
    @property
    def walk_m(self) -> float: ...
    @property
    def scan_min(self) -> float: ...
    @property
    def set_up_min(self) -> float: ...
    @property
    def photos_min(self) -> float: ...
    @property
    def walk_min(self) -> float: ...
    @property
    def minutes(self) -> float: ...
    @property
    def unconnected(self) -> int: ...
    @property
    def unlinked(self) -> int: ...
    @property
    def batteries(self) -> List[BatteryUse]: ...

class Session(Round):
    @property
    def day(self) -> int: ...
    @property
    def crew(self) -> int: ...
    @property
    def parts(self) -> int: ...
    @property
    def linked(self) -> bool: ...
    @property
    def start_min(self) -> float: ...
    @property
    def wait_min(self) -> List[float]: ...
    @property
    def waiting_min(self) -> float: ...

class ClosedStation:
    @property
    def station(self) -> int: ...
    @property
    def why(self) -> str: ...

class Visit(Round):
    @property
    def day_min(self) -> float: ...
    @property
    def sessions(self) -> List[Session]: ...
    @property
    def not_split(self) -> str: ...
    @property
    def closed(self) -> List[ClosedStation]: ...
    @property
    def bound(self) -> int: ...
    @property
    def batteries(self) -> List[BatteryUse]: ...

class RegistrationOptions:
    def __init__(
        self,
        *,
        rho_m: float = 0.0015,
        patch_m: float = 0.5,
        position_m: float = 0.03,
        heading_deg: float = 0.2,
        tilt_deg: float = 0.004166666667,
        tilt_of_scanner: bool = False,
        surfaces: Literal["surveyed", "all"] = "surveyed",
    ) -> None: ...
    rho_m: float
    patch_m: float
    position_m: float
    heading_deg: float
    tilt_deg: float
    tilt_of_scanner: bool
    surfaces: Literal["surveyed", "all"]

class RegistrationError:
    @property
    def rms_m(self) -> float: ...
    @property
    def random_m(self) -> float: ...
    @property
    def worst_m(self) -> float: ...
    @property
    def worst_station(self) -> int: ...
    @property
    def station_rms_m(self) -> Floats: ...
    @property
    def head_covariance_m2(self) -> Floats: ...

class Connectivity:
    @property
    def parts(self) -> int: ...
    @property
    def part(self) -> List[int]: ...
    @property
    def bridges(self) -> List[Tuple[int, int]]: ...
    @property
    def weakest_link(self) -> Tuple[int, int]: ...
    @property
    def weakest_overlap(self) -> float: ...

class Evaluation:
    @property
    def coverage(self) -> float: ...
    @property
    def coverage_se(self) -> float: ...
    @property
    def overlap(self) -> float: ...
    @property
    def overlap_se(self) -> float: ...
    @property
    def overlap_matrix(self) -> Floats: ...
    @property
    def overlap_matrix_se(self) -> Floats: ...
    @property
    def scan_overlap_matrix(self) -> Floats: ...
    def connectivity(self, min_overlap: float = 0.01) -> Connectivity: ...
    def scan_connectivity(self, min_overlap: float = 0.3) -> Connectivity: ...
    @property
    def registration(self) -> RegistrationError: ...
    @property
    def registration_estimate(self) -> Tuple[float, float]: ...
    @property
    def seen(self) -> npt.NDArray[np.uint64]: ...
    @property
    def shared(self) -> npt.NDArray[np.uint64]: ...
    @property
    def points(self) -> npt.NDArray[np.uint64]: ...
    @property
    def points_on_surveyed(self) -> npt.NDArray[np.uint64]: ...
    @property
    def mixed(self) -> npt.NDArray[np.uint64]: ...
    @property
    def voxel_points(self) -> npt.NDArray[np.uint32]: ...
    @property
    def voxel_stations(self) -> npt.NDArray[np.uint64]: ...
    def value(self, name: str) -> float: ...
    @property
    def voxels(self) -> int: ...
    @property
    def sample(self) -> int: ...
    @property
    def goal_density(self) -> float: ...
    @property
    def stations(self) -> int: ...
    @property
    def heads(self) -> Floats: ...
    @property
    def rays(self) -> int: ...
    @property
    def trace_seconds(self) -> float: ...
    @property
    def cancelled(self) -> bool: ...
    @property
    def data(self) -> Optional[Dict[str, float]]: ...
    @property
    def visit(self) -> Optional[Visit]: ...
    @property
    def summary(self) -> str: ...
    def to_dict(self) -> Dict[str, Any]: ...
    def plot(self, ax: Any = None, site: Optional[Site] = None, link: float = 0.3) -> Any: ...

class EngineInfo:
    @property
    def engine(self) -> Literal["auto", "ray_query", "compute_bvh", "embree"]: ...
    @property
    def device(self) -> str: ...
    @property
    def driver(self) -> str: ...
    @property
    def device_index(self) -> int: ...
    @property
    def usable(self) -> bool: ...
    @property
    def software(self) -> bool: ...
    @property
    def chosen_by_default(self) -> bool: ...
    @property
    def reason(self) -> str: ...

def list_engines() -> List[EngineInfo]: ...
def all_devices(
    engine: Literal["auto", "ray_query", "compute_bvh", "embree"] = "auto",
) -> List[Tuple[Literal["auto", "ray_query", "compute_bvh", "embree"], Optional[int]]]: ...

class BeamOptions:
    def __init__(
        self,
        *,
        sub_rays: int = 7,
        returns: Literal["first", "strongest", "last", "all"] = "strongest",
        pulse_m: float = 1.0,
    ) -> None: ...
    sub_rays: int
    returns: Literal["first", "strongest", "last", "all"]
    pulse_m: float

class Scan:
    @property
    def row(self) -> npt.NDArray[np.uint32]: ...
    @property
    def column(self) -> npt.NDArray[np.uint32]: ...
    @property
    def range_m(self) -> npt.NDArray[np.float32]: ...
    @property
    def position(self) -> Floats: ...
    @property
    def normal(self) -> npt.NDArray[np.float32]: ...
    @property
    def reflectivity(self) -> npt.NDArray[np.float32]: ...
    @property
    def mesh(self) -> npt.NDArray[np.int32]: ...
    @property
    def primitive(self) -> npt.NDArray[np.uint32]: ...
    @property
    def colour(self) -> npt.NDArray[np.uint32]: ...
    @property
    def voxel(self) -> npt.NDArray[np.uint32]: ...
    @property
    def ghost(self) -> npt.NDArray[np.uint8]: ...
    @property
    def returns(self) -> npt.NDArray[np.uint8]: ...
    @property
    def return_number(self) -> npt.NDArray[np.uint8]: ...
    @property
    def rows(self) -> int: ...
    @property
    def columns(self) -> int: ...
    @property
    def rays(self) -> int: ...
    @property
    def points(self) -> int: ...
    @property
    def points_on_surveyed(self) -> int: ...
    @property
    def mixed(self) -> Tuple[int, int, int]: ...
    @property
    def trace_seconds(self) -> float: ...
    @property
    def cancelled(self) -> bool: ...
    def __len__(self) -> int: ...

class Simulator:
    def __init__(
        self,
        scene: Scene,
        scanner: Union[Scanner, Sequence[Scanner]],
        *,
        engine: Literal["auto", "ray_query", "compute_bvh", "embree"] = "auto",
        device_index: Optional[int] = None,
        devices: Sequence[Tuple[Literal["auto", "ray_query", "compute_bvh", "embree"], Optional[int]]] = [],
        max_memory_bytes: int = 0,
        user_size_m: float = 0.1,
        point_spacing_m: float = 0.01,
        spacing_by_detail: bool = False,
        max_incidence_deg: Optional[float] = None,
        noise: bool = True,
        seed: int = 1,
        validation: bool = False,
        max_rays_per_dispatch: int = 0,
    ) -> None: ...
    @property
    def engine(self) -> EngineInfo: ...
    @property
    def scanner(self) -> Scanner: ...
    @property
    def scanners(self) -> List[Scanner]: ...
    @property
    def scene(self) -> Scene: ...
    @property
    def origin(self) -> Vec3: ...
    @property
    def voxel_count(self) -> int: ...
    @property
    def voxel_size_m(self) -> float: ...
    @property
    def goal_density(self) -> float: ...
    def set_scene(self, scene: Scene) -> bool: ...
    def set_scanners(self, scanners: Sequence[Scanner]) -> None: ...
    def voxel_centres(self) -> Floats: ...
    def voxel_weights(self) -> npt.NDArray[np.uint32]: ...
    def goal_densities(self) -> Floats: ...
    def scan(
        self,
        position: Point,
        outputs: Sequence[str] = ["position", "reflectivity"],
        *,
        setup: StationSetup = ...,
        grid: bool = False,
        place: int = 0,
        beam: Optional[BeamOptions] = None,
        instrument: Optional[InstrumentErrors] = None,
        progress: Optional[Progress] = None,
    ) -> Scan: ...
    def scan_array(
        self,
        position: Point,
        outputs: Sequence[str] = ["position", "reflectivity"],
        *,
        float32: bool = False,
        setup: StationSetup = ...,
        place: int = 0,
        beam: Optional[BeamOptions] = None,
        instrument: Optional[InstrumentErrors] = None,
        progress: Optional[Progress] = None,
    ) -> npt.NDArray[Any]: ...
    def evaluate(
        self,
        stations: Stations,
        *,
        overlap: bool = True,
        skip: bool = True,
        field: bool = False,
        surroundings: bool = False,
        registration: Optional[RegistrationOptions] = None,
        beam: Optional[BeamOptions] = None,
        progress: Optional[Progress] = None,
    ) -> Evaluation: ...
    def evaluate_sampled(
        self,
        networks: Sequence[Stations],
        *,
        voxels: int = 20000,
        overlap: bool = True,
        surroundings: bool = False,
        registration: Optional[RegistrationOptions] = None,
        progress: Optional[Progress] = None,
    ) -> List[Evaluation]: ...

def write_point_cloud(
    file: Path,
    simulator: Simulator,
    stations: Stations,
    *,
    outputs: Sequence[str] = ["reflectivity"],
    crs: str = "",
    beam: Optional[BeamOptions] = None,
    instrument: Optional[InstrumentErrors] = None,
    doubles: bool = False,
    progress: Optional[Progress] = None,
) -> int: ...

class UncoveredVoxels:
    @property
    def voxels(self) -> npt.NDArray[np.uint32]: ...
    @property
    def centres(self) -> Floats: ...
    @property
    def meshes(self) -> npt.NDArray[np.uint32]: ...
    @property
    def points(self) -> npt.NDArray[np.uint32]: ...
    def __len__(self) -> int: ...

def uncovered(simulator: Simulator, evaluation: Evaluation) -> UncoveredVoxels: ...

class SiteChoice:
    @property
    def setting(self) -> str: ...
    @property
    def value(self) -> str: ...
    @property
    def why(self) -> str: ...

class Site:
    def __init__(
        self,
        scene: Scene,
        *,
        scanners: Sequence[Scanner] = [],
        name: str = "site",
        scanner: Setting = None,
        step: Setting = None,
        heading: Setting = None,
        horizontal: Setting = None,
        vertical: Setting = None,
        zenith_start: Setting = None,
        height: Setting = None,
        range: Setting = None,
        noise: Setting = None,
        beam: Setting = None,
        calibration: Setting = None,
        detection: Setting = None,
        dropout: Setting = None,
        rate: Setting = None,
        battery: Setting = None,
        user_size: Setting = None,
        incidence: Setting = None,
        spacing: Setting = None,
        for_: Setting = None,
        spacing_by_detail: Setting = None,
        security: Setting = None,
        slope: Setting = None,
        headroom: Setting = None,
        min_area: Setting = None,
        passage: Setting = None,
        climb: Setting = None,
        enter: Setting = None,
        levels: Setting = None,
        within: Setting = None,
        without: Setting = None,
        engine: Setting = None,
        device: Setting = None,
        seed: Setting = None,
        memory: Setting = None,
        validation: Setting = None,
        crs: Setting = None,
    ) -> None: ...
    @staticmethod
    def open(
        file: Path,
        *,
        beside: Setting = None,
        surveyed: Setting = None,
        blocking: Setting = None,
        search: Setting = None,
        ignore: Setting = None,
        glass: Setting = None,
        mirror: Setting = None,
        weight: Setting = None,
        detail: Setting = None,
        accuracy: Setting = None,
        unit: Setting = None,
        up: Setting = None,
        wall_layer: Setting = None,
        wall_height: Setting = None,
        scene_index: Setting = None,
        diffuse: Setting = None,
        shared_meshes: Setting = None,
        allow_outside: Setting = None,
        scanner: Setting = None,
        step: Setting = None,
        heading: Setting = None,
        horizontal: Setting = None,
        vertical: Setting = None,
        zenith_start: Setting = None,
        height: Setting = None,
        range: Setting = None,
        noise: Setting = None,
        beam: Setting = None,
        calibration: Setting = None,
        detection: Setting = None,
        dropout: Setting = None,
        rate: Setting = None,
        battery: Setting = None,
        user_size: Setting = None,
        incidence: Setting = None,
        spacing: Setting = None,
        for_: Setting = None,
        spacing_by_detail: Setting = None,
        security: Setting = None,
        slope: Setting = None,
        headroom: Setting = None,
        min_area: Setting = None,
        passage: Setting = None,
        climb: Setting = None,
        enter: Setting = None,
        doors: Setting = None,
        station_area: Setting = None,
        levels: Setting = None,
        within: Setting = None,
        without: Setting = None,
        engine: Setting = None,
        device: Setting = None,
        seed: Setting = None,
        memory: Setting = None,
        validation: Setting = None,
        crs: Setting = None,
    ) -> Site: ...
    @property
    def name(self) -> str: ...
    @property
    def scene(self) -> Scene: ...
    @property
    def scanners(self) -> List[Scanner]: ...
    @property
    def area(self) -> SearchArea: ...
    @property
    def clash(self) -> ClashChecker: ...
    @property
    def simulator(self) -> Simulator: ...
    @property
    def choices(self) -> List[SiteChoice]: ...
    def evaluate(
        self,
        stations: Stations,
        *,
        sample_voxels: Optional[int] = None,
        overlap: bool = True,
        skip: bool = False,
        field: bool = False,
        link: float = 0.3,
        registration: Optional[RegistrationOptions] = None,
        beam: Optional[BeamOptions] = None,
        progress: Optional[Progress] = None,
    ) -> Evaluation: ...
    def nearest_place(self, head: Point, reach_m: float = 5.0) -> Optional[PlacedStation]: ...
    def write_report(
        self,
        file: Path,
        evaluation: Evaluation,
        *,
        title: Optional[str] = None,
        progress: Optional[Progress] = None,
    ) -> None: ...
    def plan(
        self,
        problem: Union[None, str, SurveyProblem] = None,
        *,
        start: Sequence[Point] = [],
        checkpoint: Optional[Path] = None,
        existing_targets: Sequence[Target] = [],
        progress: Optional[Callable[[PlanProgress], Any]] = None,
        capture: Setting = None,
        pays: Setting = None,
        link: Setting = None,
        apart: Setting = None,
        max_time_on_site: Setting = None,
        set_up: Setting = None,
        photos: Setting = None,
        walking: Setting = None,
        day: Setting = None,
        crews: Setting = None,
        day_start: Setting = None,
        window: Setting = None,
        objectives: Setting = None,
        require: Setting = None,
        stations: Setting = None,
        search_step: Setting = None,
        heights: Setting = None,
        link_overlap: Setting = None,
        min_overlap: Setting = None,
        fitness: Setting = None,
        registration_rho: Setting = None,
        registration_patch: Setting = None,
        registration_position: Setting = None,
        registration_heading: Setting = None,
        registration_tilt: Setting = None,
        registration_surfaces: Setting = None,
        targets: Setting = None,
        target_diameter: Setting = None,
        target_height: Setting = None,
        target_sigma: Setting = None,
        accuracy_class: Setting = None,
        population: Setting = None,
        iterations: Setting = None,
        batch: Setting = None,
        redraws: Setting = None,
        stagnation: Setting = None,
        sigma: Setting = None,
        scheme: Setting = None,
        max_time: Setting = None,
        target_hypervolume: Setting = None,
        exact: Setting = None,
        sample: Setting = None,
        renew: Setting = None,
        save_every: Setting = None,
        resume: Setting = None,
    ) -> PlanResult: ...
    def next(
        self,
        scans: Path,
        planned: Optional[Stations] = None,
        *,
        planned_names: Sequence[str] = [],
        progress: Optional[Progress] = None,
        capture: Setting = None,
        link: Setting = None,
        most: Setting = None,
        unknown: Setting = None,
        tolerance: Setting = None,
        taken_within: Setting = None,
    ) -> Optional[NextResult]: ...
    def plot(self, ax: Any = None) -> Any: ...

def place_heads(site: Site, heads: Stations) -> List[PlacedStation]: ...

class OnSite:
    def __init__(self, site: Site, options: OnSiteOptions = ...) -> None: ...
    def way_m(self, start: Point, end: Point) -> Optional[float]: ...
    def way(self, start: Point, end: Point) -> List[Vec3]: ...
    def visit(self, stations: Stations) -> Visit: ...

class RayHits:
    @property
    def range_m(self) -> Floats: ...
    @property
    def position(self) -> Floats: ...
    @property
    def normal(self) -> npt.NDArray[np.float32]: ...
    @property
    def reflectivity(self) -> npt.NDArray[np.float32]: ...
    @property
    def diffuse(self) -> npt.NDArray[np.float32]: ...
    @property
    def mesh(self) -> npt.NDArray[np.int32]: ...
    @property
    def primitive(self) -> npt.NDArray[np.uint32]: ...
    def __len__(self) -> int: ...

class RayTracer:
    def __init__(
        self,
        scene: Scene,
        *,
        engine: Literal["auto", "ray_query", "compute_bvh", "embree"] = "embree",
        device_index: Optional[int] = None,
    ) -> None: ...
    @property
    def scene(self) -> Scene: ...
    @property
    def engine(self) -> EngineInfo: ...
    def nearest(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        ranges_m: Optional[npt.ArrayLike] = None,
        from_m: float = 0.0,
        glass: bool = False,
        progress: Optional[Progress] = None,
    ) -> RayHits: ...
    def blocked(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        ranges_m: Optional[npt.ArrayLike] = None,
        from_m: float = 0.0,
        glass: bool = False,
        progress: Optional[Progress] = None,
    ) -> npt.NDArray[np.bool_]: ...
    def count(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        ranges_m: Optional[npt.ArrayLike] = None,
        from_m: float = 0.0,
        glass: bool = False,
        progress: Optional[Progress] = None,
    ) -> npt.NDArray[np.uint32]: ...

class MissedVoxels:
    @property
    def voxels(self) -> npt.NDArray[np.uint32]: ...
    @property
    def points(self) -> npt.NDArray[np.uint32]: ...
    @property
    def why(self) -> npt.NDArray[np.uint8]: ...
    @property
    def reasons(self) -> List[str]: ...
    @property
    def shares(self) -> Dict[str, Dict[str, float]]: ...
    @property
    def rooms(self) -> List[Dict[str, Any]]: ...
    @property
    def candidates(self) -> int: ...

def why_missed(
    site: Site,
    evaluation: Evaluation,
    *,
    progress: Optional[Progress] = None,
    candidates: int = 256,
    flat_deg: float = 80.0,
) -> MissedVoxels: ...

class CoverageMatrix:
    def __init__(self, weights: Sequence[int], goal: float, amounts: Sequence[Sequence[int]]) -> None: ...
    def __len__(self) -> int: ...
    def column(self, candidate: int) -> npt.NDArray[np.uint32]: ...
    @property
    def weights(self) -> npt.NDArray[np.uint32]: ...
    @property
    def goal(self) -> float: ...
    def coverage(self, chosen: Sequence[int]) -> float: ...

class SampledCoverage:
    def __len__(self) -> int: ...
    @property
    def matrix(self) -> CoverageMatrix: ...
    @property
    def voxels(self) -> npt.NDArray[np.uint32]: ...
    @property
    def cancelled(self) -> bool: ...
    def coverage(self, stations: Optional[Sequence[int]] = None) -> Tuple[float, float]: ...

def sample_coverage(
    simulator: Simulator,
    stations: Sequence[PlacedStation],
    *,
    sample_voxels: int = 20000,
    progress: Optional[Progress] = None,
) -> SampledCoverage: ...

class StationGraph:
    def __init__(self, overlaps: npt.ArrayLike, excluded: Sequence[Tuple[int, int]] = []) -> None: ...
    def __len__(self) -> int: ...
    @property
    def overlaps(self) -> npt.NDArray[np.float32]: ...

def overlap_graph(
    simulator: Simulator,
    stations: Sequence[PlacedStation],
    *,
    sample_voxels: int = 10000,
    progress: Optional[Progress] = None,
) -> StationGraph: ...

class Candidates:
    @property
    def stations(self) -> List[PlacedStation]: ...
    @property
    def coverage(self) -> SampledCoverage: ...
    @property
    def attainable(self) -> Tuple[float, float]: ...
    @property
    def captured_matrix(self) -> CoverageMatrix: ...
    @property
    def change(self) -> float: ...
    @property
    def ended(self) -> Literal["enough", "all", "most", "time", "cancelled"]: ...
    @property
    def spacing_m(self) -> float: ...
    def __len__(self) -> int: ...

def find_candidates(
    site: Site,
    *,
    progress: Optional[Progress] = None,
    first: int = 128,
    most: int = 4096,
    change: float = 0.01,
    sample_voxels: Optional[int] = 20000,
    scanner: int = 0,
    max_seconds: float = 0.0,
) -> Candidates: ...

class CoverSolution:
    @property
    def chosen(self) -> List[int]: ...
    @property
    def coverage(self) -> float: ...
    @property
    def link(self) -> float: ...
    @property
    def violation(self) -> float: ...
    @property
    def bound(self) -> float: ...
    @property
    def relaxation(self) -> float: ...
    @property
    def complete(self) -> bool: ...
    @property
    def half_bound(self) -> float: ...
    @property
    def spacing_term(self) -> float: ...
    @property
    def gap(self) -> float: ...

class StationsBound:
    @property
    def possible(self) -> bool: ...
    @property
    def at_least(self) -> int: ...
    @property
    def relaxation(self) -> float: ...
    @property
    def complete(self) -> bool: ...
    @property
    def chosen(self) -> List[int]: ...

def max_cover(
    matrix: CoverageMatrix,
    stations: int,
    existing: Sequence[int] = [],
    *,
    graph: Optional[StationGraph] = None,
    link: float = 0.0,
    progress: Optional[Progress] = None,
    tolerance: float = 0.001,
    max_seconds: float = 120.0,
    exact_seconds: float = 0.0,
) -> CoverSolution: ...
def min_cover(
    matrix: CoverageMatrix,
    coverage: float,
    existing: Sequence[int] = [],
    *,
    progress: Optional[Progress] = None,
    tolerance: float = 0.001,
    max_seconds: float = 120.0,
    exact_seconds: float = 0.0,
) -> StationsBound: ...
def greedy(matrix: CoverageMatrix, stations: int, existing: Sequence[int] = []) -> List[int]: ...
def improve_by_swaps(
    matrix: CoverageMatrix,
    chosen: Sequence[int],
    existing: Sequence[int] = [],
    *,
    progress: Optional[Progress] = None,
) -> List[int]: ...
def min_connected_cover(
    matrix: CoverageMatrix,
    coverage: float,
    graph: StationGraph,
    link: float,
    existing: Sequence[int] = [],
    *,
    most: Optional[int] = None,
    progress: Optional[Progress] = None,
) -> CoverSolution: ...

class GreedyResult:
    @property
    def stations(self) -> List[PlacedStation]: ...
    @property
    def coverage(self) -> List[float]: ...
    @property
    def cancelled(self) -> bool: ...

def greedy_network(
    site: Site,
    stations: int,
    *,
    progress: Optional[Progress] = None,
    candidates: int = 300,
    sample_voxels: Optional[int] = 20000,
    existing: Sequence[Point] = [],
    existing_setups: Sequence[StationSetup] = [],
) -> GreedyResult: ...

class ExactResult:
    @property
    def stations(self) -> List[PlacedStation]: ...
    @property
    def choice(self) -> CoverSolution: ...
    @property
    def cancelled(self) -> bool: ...

def exact_network(
    site: Site,
    stations: int,
    *,
    progress: Optional[Progress] = None,
    candidates: int = 256,
    sample_voxels: Optional[int] = 20000,
    link: float = 0.0,
    apart_m: float = 0.0,
    max_seconds: float = 60.0,
    existing: Sequence[Point] = [],
    existing_setups: Sequence[StationSetup] = [],
) -> ExactResult: ...

class MeasuredNetwork:
    @property
    def evaluation(self) -> Evaluation: ...
    @property
    def stations(self) -> List[PlacedStation]: ...
    @property
    def heads(self) -> Floats: ...
    @property
    def existing(self) -> int: ...
    @property
    def visible_parts(self) -> int: ...
    @property
    def minutes_on_site(self) -> float: ...
    @property
    def surroundings(self) -> Optional[Evaluation]: ...
    def captured(self, meshes: str) -> float: ...

class Scale:
    @property
    def best(self) -> float: ...
    @property
    def worst(self) -> float: ...

def minimise(best: float, worst: float) -> Scale: ...
def maximise(best: float, worst: float) -> Scale: ...

class Objective:
    def __init__(
        self,
        name: str,
        value: Callable[[MeasuredNetwork], float],
        scale: Scale,
        *,
        label: str = "",
        unit: str = "",
        counts: bool = True,
        pairs: bool = False,
        visibility: bool = False,
        surroundings: bool = False,
        time: bool = False,
        meshes: bool = False,
        registration: Optional[RegistrationOptions] = None,
        standard_error: Optional[Callable[[MeasuredNetwork], float]] = None,
        parameters: str = "",
    ) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def label(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def scale(self) -> Scale: ...

class Requirement:
    def __init__(self, objective: Objective, bound: Literal[">=", "<="], limit: float) -> None: ...
    @property
    def objective(self) -> Objective: ...
    @property
    def limit(self) -> float: ...

def objective_names() -> List[str]: ...

class SurveyProblem:
    def __init__(
        self,
        *,
        name: str = "custom",
        stations_min: int = 4,
        stations_max: int = 4,
        existing: Iterable[Point] = (),
        existing_setups: Iterable[StationSetup] = (),
        existing_names: Iterable[str] = (),
        scanners: Iterable[Scanner] = (),
        every_echo: bool = False,
        heights_m: Optional[Tuple[float, float]] = None,
        link_overlap: float = 0.01,
        registration: RegistrationOptions = ...,
        on_site: OnSiteOptions = ...,
        targets: Optional[int] = None,
        existing_targets: Iterable[Target] = (),
        fewest: bool = False,
        pays_m2: Optional[float] = None,
        pays_share: float = 0.0,
        attainable: Optional[float] = None,
        objectives: Iterable[Union[str, Objective]] = (),
        requirements: Iterable[Union[str, Requirement]] = (),
    ) -> None: ...
    def to_dict(self) -> Dict[str, Any]: ...
    name: str
    stations_min: int
    stations_max: int
    @property
    def existing(self) -> Tuple[Vec3, ...]: ...
    @existing.setter
    def existing(self, given: Iterable[Point]) -> None: ...
    @property
    def existing_setups(self) -> Tuple[StationSetup, ...]: ...
    @existing_setups.setter
    def existing_setups(self, given: Iterable[StationSetup]) -> None: ...
    @property
    def existing_names(self) -> Tuple[str, ...]: ...
    @existing_names.setter
    def existing_names(self, given: Iterable[str]) -> None: ...
    @property
    def scanners(self) -> Tuple[Scanner, ...]: ...
    @scanners.setter
    def scanners(self, given: Iterable[Scanner]) -> None: ...
    every_echo: bool
    heights_m: Optional[Tuple[float, float]]
    link_overlap: float
    registration: RegistrationOptions
    on_site: OnSiteOptions
    targets: Optional[int]
    @property
    def existing_targets(self) -> Tuple[Target, ...]: ...
    @existing_targets.setter
    def existing_targets(self, given: Iterable[Target]) -> None: ...
    fewest: bool
    pays_m2: Optional[float]
    pays_share: float
    attainable: Optional[float]
    @property
    def objectives(self) -> Tuple[Objective, ...]: ...
    @objectives.setter
    def objectives(self, given: Iterable[Union[str, Objective]]) -> None: ...
    @property
    def requirements(self) -> Tuple[Requirement, ...]: ...
    @requirements.setter
    def requirements(self, given: Iterable[Union[str, Requirement]]) -> None: ...

def coverage_fix(stations: int) -> SurveyProblem: ...
def coverage_overlap_fix(stations: int) -> SurveyProblem: ...
def coverage_min(stations_min: int, stations_max: int) -> SurveyProblem: ...
def coverage_overlap_min(stations_min: int, stations_max: int) -> SurveyProblem: ...
def fitness_min(
    stations_min: int,
    stations_max: int,
    coverage: float = 0.4,
    station_count: float = 0.4,
    visibility: float = 0.2,
) -> SurveyProblem: ...
def fewest_stations(
    capture: float = 0.9,
    link: float = 0.3,
    stations_min: int = 1,
    stations_max: int = 1024,
    apart_m: float = 1.0,
) -> SurveyProblem: ...

class PlanProgress:
    @property
    def phase(self) -> Literal["look", "choose", "search", "confirm"]: ...
    @property
    def iteration(self) -> int: ...
    @property
    def iterations(self) -> int: ...
    @property
    def evaluations(self) -> int: ...
    @property
    def evaluations_per_second(self) -> float: ...
    @property
    def hypervolume(self) -> float: ...
    @property
    def seconds_left(self) -> float: ...
    @property
    def whole_seconds_left(self) -> Optional[float]: ...
    @property
    def attainable(self) -> Optional[float]: ...
    @property
    def front(self) -> Floats: ...

class MeasuredValue:
    @property
    def searched(self) -> float: ...
    @property
    def standard_error(self) -> float: ...
    @property
    def exact(self) -> float: ...
    @property
    def best_known(self) -> float: ...

class PlanEntry:
    @property
    def x(self) -> Floats: ...
    @property
    def stations(self) -> List[PlacedStation]: ...
    @property
    def heads(self) -> Floats: ...
    @property
    def values(self) -> Dict[str, MeasuredValue]: ...
    def value(self, name: str) -> float: ...
    @property
    def confirmed(self) -> bool: ...
    @property
    def dominated(self) -> bool: ...
    @property
    def missed(self) -> float: ...
    @property
    def overlap_matrix(self) -> Floats: ...
    @property
    def scan_overlap_matrix(self) -> Floats: ...
    @property
    def registration(self) -> Optional[RegistrationError]: ...
    @property
    def targets(self) -> List[Target]: ...
    @property
    def without_targets_m(self) -> Optional[float]: ...
    @property
    def data(self) -> Optional[Dict[str, float]]: ...
    @property
    def visit(self) -> Optional[Visit]: ...

class PlanResult:
    @property
    def front(self) -> List[PlanEntry]: ...
    @property
    def answer(self) -> PlanEntry: ...
    @property
    def met(self) -> bool: ...
    @property
    def what_would_help(self) -> List[str]: ...
    @property
    def measures(self) -> List[str]: ...
    @property
    def scanners(self) -> List[Scanner]: ...
    @property
    def history(self) -> List[Dict[str, Any]]: ...
    @property
    def hypervolume(self) -> float: ...
    @property
    def exact_hypervolume(self) -> float: ...
    @property
    def evaluations(self) -> int: ...
    @property
    def stop_reason(self) -> str: ...
    @property
    def seconds(self) -> float: ...
    @property
    def site(self) -> Site: ...
    @property
    def summary(self) -> str: ...
    def to_dict(self) -> Dict[str, Any]: ...
    def write(
        self,
        folder: Path,
        *,
        title: Optional[str] = None,
        reports: bool = True,
        max_seconds: Optional[float] = None,
        doubles: bool = False,
        progress: Optional[Progress] = None,
    ) -> List[str]: ...
    def write_report(self, file: Path, *, title: Optional[str] = None, progress: Optional[Progress] = None) -> None: ...
    def plot(self, ax: Any = None, link: float = 0.3) -> Any: ...

class NextResult:
    @property
    def captured(self) -> Tuple[float, float]: ...
    @property
    def captured_then(self) -> float: ...
    @property
    def enough(self) -> bool: ...
    @property
    def taken(self) -> List[PlacedStation]: ...
    @property
    def stations(self) -> List[PlacedStation]: ...
    @property
    def names(self) -> List[str]: ...
    @property
    def visit(self) -> Visit: ...
    @property
    def found(self) -> Site: ...
    def to_dict(self) -> Dict[str, Any]: ...
    def write(self, folder: Path) -> None: ...
