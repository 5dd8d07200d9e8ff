from .laws import HeadingAveraging as HeadingAveraging
