"""What a class says of its methods, where subclasses change them."""

import pytest

from flockana.base.overrides import speaks_for


class Base:
    def form(self): ...
    def act(self): ...


class Unchanged(Base):
    def other(self): ...


class Changed(Base):
    def act(self): ...


class Both(Changed):
    def form(self): ...


class Later(Both):
    def act(self): ...


@pytest.mark.parametrize(("kind", "true"), [(Base, 1), (Unchanged, 1), (Changed, 0), (Both, 1), (Later, 0)])
def test_a_form_holds_until_a_subclass_changes_what_it_stands_for(kind, true):
    assert speaks_for(kind, "form", ["act"]) == bool(true)
