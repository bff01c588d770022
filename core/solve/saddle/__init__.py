"""The saddle-point system (41) of [RS21]: what is done with a tangent space of the constraints, and how."""

from .tangent_space import LinearMap, TangentSpace
