from .laws import SafetyFilter as SafetyFilter
