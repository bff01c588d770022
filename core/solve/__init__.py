"""Metrics, constraints, and the saddle-point system (41) that joins them."""
