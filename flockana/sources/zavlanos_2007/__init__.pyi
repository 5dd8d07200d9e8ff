from .laws import LinkKeeping as LinkKeeping
