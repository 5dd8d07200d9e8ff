from .laws import MSNDiscretisation as MSNDiscretisation
