from .laws import CuckerDong as CuckerDong
