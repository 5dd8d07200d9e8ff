from .laws import SingularAlignment as SingularAlignment
