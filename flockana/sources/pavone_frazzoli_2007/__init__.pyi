from .laws import CyclicPursuit as CyclicPursuit
