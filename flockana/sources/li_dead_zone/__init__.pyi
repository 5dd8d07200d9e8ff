from . import symbolic as symbolic
from .interactions import DeadZoneInteraction as DeadZoneInteraction
from .laws.dead_zone import DeadZoneFlocking as DeadZoneFlocking
from .laws.with_leaders import LedDeadZoneFlocking as LedDeadZoneFlocking
