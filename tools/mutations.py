"""The changes that ``mutants.py`` makes, each with the test that names the behaviour which it breaks."""

from typing import NamedTuple

SEARCHES, CONDITIONS = "tests/core/descent/test_searches.py", "tests/core/descent/test_conditions.py"
DIRECTIONS, CLAIMS = "tests/core/descent/test_directions.py", "tests/core/descent/test_claims.py"
FIRST_TRIAL, METRIC_AGE = "tests/core/descent/test_first_trial.py", "tests/core/descent/test_metric_age.py"
RESTORATION, ADAPTIVE = "tests/core/test_restoration.py", "tests/core/test_adaptive.py"
AVOID, OBSTACLES = "tests/core/test_avoid.py", "tests/core/collision/test_obstacles_exactly.py"
CERTIFICATE, VERIFY, GROW = "tests/core/test_certificate.py", "tests/core/verify", "tests/core/test_grow.py"


class Mutant(NamedTuple):
    """One change, and the test that must notice."""

    name: str
    file: str
    old: str
    new: str
    test: str


MUTANTS = (
    Mutant(
        "conjugate gradients are steepest descent",
        "core/descent/directions/conjugate_gradient.py",
        "beta = max(0.0, ",
        "beta = 0.0 * max(0.0, ",
        f"{DIRECTIONS}::test_conjugate_gradients_by_their_formula",
    ),
    Mutant(
        "implicit Euler is explicit",
        "core/descent/searches/backward_euler.py",
        "right = -(trial.derivative +",
        "right = -(point.derivative +",
        f"{CONDITIONS}::test_backward_euler_takes_the_gradient_at_the_end",
    ),
    Mutant(
        "Nesterov without momentum",
        "core/descent/searches/accelerated.py",
        "(memory.t - 1.0) / t *",
        "0.0 * (memory.t - 1.0) / t *",
        f"{CONDITIONS}::test_nesterov_goes_on_in_the_direction_of_the_last_step",
    ),
    Mutant(
        "half the penalty's derivative",
        "core/descent/penalised.py",
        "2.0 * weights * stretch",
        "weights * stretch",
        f"{DIRECTIONS}::test_the_penalised_energy_has_slope_two",
    ),
    Mutant(
        "trust region without the last gradient",
        "core/descent/searches/trust_region.py",
        "if last_gradient is not None:",
        "if False:",
        f"{CONDITIONS}::test_trust_region_uses_the_last_gradient",
    ),
    Mutant(
        "trust region without its ratio test",
        "core/descent/searches/trust_region.py",
        "_ratio(point, q, predicted) >= self.accept",
        "_ratio(point, q, predicted) > 0.0",
        f"{CONDITIONS}::test_trust_region_rejects_what_the_model_did_not_foresee",
    ),
    Mutant(
        "no curvature condition",
        "core/descent/searches/wolfe.py",
        "if self.flat(trial.end, direction, slope) or tau >= end:",
        "if True:",
        f"{CONDITIONS}::test_wolfe_does_not_take_steps_that_are_too_short",
    ),
    Mutant(
        "footnote 8 reversed",
        "core/descent/penalised.py",
        "self.penalty if problem.metric.extends_penalty else 0.0",
        "0.0 if problem.metric.extends_penalty else self.penalty",
        f"{CLAIMS}::test_penalised_methods_in_the_l2_metric_are_not_extended",
    ),
    Mutant(
        "the first trial is the whole way to contact",
        "core/descent/searches/first_trial.py",
        "collision_fraction: float = 2.0 / 3.0",
        "collision_fraction: float = 1.0",
        f"{FIRST_TRIAL}::test_the_first_trial_is_two_thirds_of_the_first_contact",
    ),
    Mutant(
        "the first trial is a tenth of the way",
        "core/descent/searches/first_trial.py",
        "collision_fraction: float = 2.0 / 3.0",
        "collision_fraction: float = 0.1",
        f"{FIRST_TRIAL}::test_the_first_trial_is_two_thirds_of_the_first_contact",
    ),
    Mutant(
        "Armijo asks for next to nothing",
        "core/descent/searches/armijo.py",
        "decrease: float = 0.5",
        "decrease: float = 1e-4",
        f"{CONDITIONS}::test_armijo_asks_for_half_of_the_predicted_decrease",
    ),
    Mutant(
        "one metric for all steps",
        "core/descent/searches/line_search.py",
        "point.metric_age + 1 < self.metric_steps",
        "True",
        f"{METRIC_AGE}::test_a_metric_serves_several_steps",
    ),
    Mutant(
        "an old metric after contact",
        "core/descent/searches/line_search.py",
        "step.limited_by is None and ",
        "",
        f"{METRIC_AGE}::test_a_metric_serves_no_longer_where_contact_limits_a_step",
    ),
    Mutant(
        "an old metric after a failed search",
        "core/descent/searches/line_search.py",
        "point.with_own_metric()",
        "point",
        f"{METRIC_AGE}::test_a_search_that_fails_gets_the_metric_of_its_curve",
    ),
    Mutant(
        "lengths move the barycenter",
        "core/saddle/restoration.py",
        "(missing - moments[own].sum(axis=0))",
        "missing",
        f"{RESTORATION}::test_corrections_solve_the_linearised_constraints_by_the_shortest_way",
    ),
    Mutant(
        "the corner that closes a component",
        "core/saddle/restoration.py",
        "w[first], w[last] = 1.0, sign",
        "w[first], w[last] = 1.0, 1.0",
        f"{RESTORATION}::test_corrections_solve_the_linearised_constraints_by_the_shortest_way",
    ),
    Mutant(
        "small residuals in the metric",
        "core/descent/constrained.py",
        "> self.small:",
        "> 0.0:",
        f"{RESTORATION}::test_the_last_corrections_converge_quadratically",
    ),
    Mutant(
        "short edges turned by the shortest corrections",
        "core/descent/constrained.py",
        "axis=1) / curve.edge_lengths))",
        "axis=1) / curve.edge_lengths.max()))",
        f"{RESTORATION}::test_edges_much_shorter_than_others_are_left_to_the_metric",
    ),
    Mutant(
        "stripes that forget the edge before",
        "core/metrics/pairs.py",
        "np.concatenate([[before], np.arange(first, last)])",
        "np.concatenate([[first], np.arange(first, last)])",
        "tests/core/test_metrics.py::test_stripes_meet_every_pair_once",
    ),
    Mutant(
        "the chord is not proved",
        "core/descent/step.py",
        "return motion if motion.open else Rejected(trial, motion.proof)",
        "return Leg(trial, FreeMotion(1.0))",
        f"{SEARCHES}::test_no_leg_is_taken_that_is_not_proved",
    ),
    Mutant(
        "a chord through a strand",
        "core/descent/step.py",
        "return motion if motion.open else Rejected(trial, motion.proof)",
        "return Leg(trial, FreeMotion(1.0))",
        f"{SEARCHES}::test_a_chord_through_a_strand_is_rejected",
    ),
    Mutant(
        "certified is a constant",
        "core/driver/run.py",
        "self._certified &= step.certified",
        "pass",
        f"{CERTIFICATE}::test_one_step_without_proof_and_nothing_after_it_is_certified",
    ),
    Mutant(
        "proofs begin beside the start",
        "core/descent/problem.py",
        "return Point(self, self.units.from_user(curve.vertices), curve.vertices)",
        "return self.at(self.units.from_user(curve.vertices))",
        f"{CERTIFICATE}::test_the_start_is_the_input_to_the_last_digit",
    ),
    Mutant(
        "roots of a polynomial that is not square-free",
        "core/verify/polynomials.py",
        "    p = square_free(p)\n    chain = [p, derivative(p)]",
        "    chain = [p, derivative(p)]",
        f"{VERIFY}/test_segments.py::test_edges_that_meet_beside_a_multiple_root",
    ),
    Mutant(
        "changes of mesh rounded to nothing",
        "core/verify/transition.py",
        "return moved, _rounded_up(largest)",
        "return moved, float(largest)",
        f"{VERIFY}/test_transitions.py::test_a_change_too_small_for_doubles_is_checked",
    ),
    Mutant(
        "triangles that collapse",
        "core/verify/filter.py",
        "chain([_triangles(heads), _ends(heads)], _overlapping(",
        "chain([_ends(heads)], _overlapping(",
        f"{VERIFY}/test_forgeries.py::test_forgeries_are_refused",
    ),
    Mutant(
        "stages that do not fit together",
        "core/verify/check.py",
        "        if last is not None:\n            _check_transition",
        "        if last is None and sizes:\n            _check_transition",
        f"{VERIFY}/test_forgeries.py::test_forgeries_are_refused",
    ),
    Mutant(
        "legs through obstacles",
        "core/descent/problem.py",
        "return free_motion(self.mesh, start, end, self.obstacles)",
        "return free_motion(self.mesh, start, end)",
        f"{AVOID}::test_no_method_goes_through_a_wall",
    ),
    Mutant(
        "ends of edges through triangles",
        "core/collision/exact_triangle.py",
        "for way in ways if way is not None]",
        "for way in ways if way is True]",
        OBSTACLES,
    ),
    Mutant(
        "a start that pierces",
        "core/collision/exact_triangle.py",
        "if after <= 0 and crossing(",
        "if after < 0 and crossing(",
        OBSTACLES,
    ),
    Mutant(
        "edges within a triangle",
        "core/collision/exact_triangle.py",
        "or not any(normal):",
        "or from_first == from_last:",
        f"{VERIFY}/test_obstacles.py::test_a_segment_meets_a_triangle_if_it_does_so_at_some_time",
    ),
    Mutant(
        "segments among triangles that repel nothing",
        "core/obstacle.py",
        "return np.asarray((i == j) | (j == k) | (k == i))",
        "return np.full(len(self.faces), self.faces.shape[1] == 2)",
        "tests/core/energies/repulsion/test_repulsion.py::test_segments_among_triangles_repel_as_segments",
    ),
    Mutant(
        "meshes that do not see walls",
        "core/driver/run.py",
        "Resolution(options.vertices, clearance=problem.clearance)",
        "Resolution(options.vertices)",
        f"{GROW}::test_edges_are_split_as_walls_come_near",
    ),
    Mutant(
        "growth measured by energies of 0",
        "core/driver/interventions/grow.py",
        "return energy_scale(self._run.problem.mesh, self._run.point.energy)",
        "return abs(self._run.point.energy)",
        f"{GROW}::test_a_straight_arc_grows",
    ),
    Mutant(
        "vertices rounded onto obstacles",
        "core/collision/rounding.py",
        " and clears(curve, obstacles, float(1.1 * rounding))",
        "",
        "tests/core/collision/test_clearance.py::test_rounding_must_not_reach_an_obstacle",
    ),
    Mutant(
        "a verifier that forgets obstacles",
        "core/verify/check.py",
        "_check_obstacles(heads, obstacles, obstacles.doubtful(start, end, heads), first, last)",
        "pass",
        f"{VERIFY}/test_obstacles.py::test_refuses_a_leg_through_an_obstacle",
    ),
    Mutant(
        "a verifier that forgets obstacles where the mesh changes",
        "core/verify/check.py",
        "_check_obstacles(heads, obstacles, obstacles.doubtful(points, points, heads, clearance=change), here, there)",
        "pass",
        f"{VERIFY}/test_obstacles.py::test_rounding_of_inserted_vertices_is_checked_for_obstacles",
    ),
    Mutant(
        "a verifier that forgets pins",
        "core/verify/check.py",
        "            held.check(frame)\n",
        "",
        f"{VERIFY}/test_pins.py::test_a_pinned_vertex_that_moves_is_named",
    ),
    Mutant(
        "pins that are not put back",
        "core/curve/pins.py",
        "        placed[self.vertices] = positions\n",
        "",
        "tests/core/test_pins.py",
    ),
    Mutant(
        "edges between pins that grow",
        "core/constraints.py",
        "lengths[free] *= factor",
        "lengths *= factor",
        f"{GROW}::test_edges_between_pins_keep_their_lengths",
    ),
    Mutant(
        "converged in the metric of another curve",
        "core/driver/termination.py",
        "run.point.with_own_metric().gradient_norm",
        "run.point.gradient_norm",
        f"{METRIC_AGE}::test_a_curve_has_converged_only_in_its_own_metric",
    ),
    Mutant(
        "changes of mesh beyond the limit",
        "core/driver/loop.py",
        "isinstance(answer, Change) and run.allows(answer)",
        "isinstance(answer, Change) and not (run.at_limit and answer.step)",
        f"{ADAPTIVE}::test_changes_of_mesh_are_within_the_limit",
    ),
    Mutant(
        "changes of mesh told by the number of vertices",
        "core/driver/run.py",
        "change.point.problem.mesh is not self.problem.mesh",
        "change.point.problem.mesh != self.problem.mesh",
        f"{ADAPTIVE}::test_another_mesh_is_another_iterate_even_of_the_same_size",
    ),
    Mutant(
        "a block list for every trial",
        "core/descent/problem.py",
        "return self if same else ",
        "return self if True else ",
        "tests/core/test_solver.py::test_a_search_compares_energies_by_the_block_list_of_its_start",
    ),
    Mutant(
        "lengths creep to their targets",
        "core/descent/searches/armijo.py",
        "wanted + slack + ROUNDING",
        "wanted + ROUNDING",
        "tests/core/test_lengths.py::test_lengths_do_not_creep_where_nothing_is_left_to_gain",
    ),
    Mutant(
        "parts let go by another mesh",
        "core/driver/prepare.py",
        "if parts is not None:\n        own_units",
        "if False:\n        own_units",
        "tests/core/test_split_links.py::test_held_parts_stay_held_on_another_mesh",
    ),
    Mutant(
        "iterates lost to signals",
        "cli/relax.py",
        "        signals.hold()\n        yield iterate",
        "        yield iterate",
        "tests/cli/test_signals.py::test_signals_wait_while_an_iterate_is_recorded",
    ),
)
