from .laws import MotschTadmor as MotschTadmor
