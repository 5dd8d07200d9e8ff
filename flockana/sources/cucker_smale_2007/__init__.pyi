from .laws import CuckerSmale as CuckerSmale
