from .laws import DistanceFormation as DistanceFormation
