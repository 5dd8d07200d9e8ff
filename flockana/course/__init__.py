"""The course: lectures as notebooks, answers that are graded, exports for graders. Nothing of the library needs it.

Grading needs no more than numpy and scipy; writing notebooks needs what ``pip install 'flockana[course]'`` installs.
"""

from flockana.course.grading import Grade, answered, form_of, grade, is_own, shows
from flockana.course.prediction import Prediction

__all__ = ["Grade", "Prediction", "answered", "form_of", "grade", "is_own", "shows"]
