"""What scikit-learn asks of an estimator besides `fit`: its parameters, so that it is cloned and searched over."""

from __future__ import annotations

from typing import Any

from geodesics.errors import BadArgument
from gmds.suggestions import did_you_mean


class Parameters:
    """Attributes that are named in `_parameters` are the parameters, and the keywords of the constructor."""

    _parameters: tuple[str, ...] = ()

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """The parameters by name."""
        return {name: getattr(self, name) for name in self._parameters}

    def set_params(self, **params: Any) -> Any:
        """Change some of them. Raises `BadArgument` (E604) for another name."""
        for name, value in params.items():
            if name not in self._parameters:
                raise BadArgument(f"there is no parameter {name!r}{did_you_mean(name, self._parameters)}")
            setattr(self, name, value)
        return self

    def __repr__(self) -> str:
        told = ", ".join(f"{name}={value!r}" for name, value in self.get_params().items())
        return f"{type(self).__name__}({told})"
