from .laws import NetAveraging as NetAveraging
