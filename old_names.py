"""Import paths of earlier versions: each still imports the module that has its content now, with a warning."""

from __future__ import annotations

import sys
import warnings
from importlib import import_module
from importlib.machinery import ModuleSpec
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.abc import Loader, MetaPathFinder
    from types import CodeType, ModuleType
else:  # `importlib.abc` takes as long to import as the rest of `hearth`
    Loader = MetaPathFinder = object

MODULES = {
    # 0.2 -> 0.3: rooms of environments and of other projects' formats
    "challenges.action_codes": "envs.action_codes",
    "challenges.answers": "envs.agent_answers",
    "challenges.edges": "envs.edge_arrays",
    "challenges.episode_export": "interop.episode_export",
    "challenges.goal_rows": "envs.goal_arrays",
    "challenges.lerobot_export": "interop.lerobot_export",
    "challenges.minari_export": "interop.minari_export",
    "challenges.observations": "envs.json_observations",
    "challenges.parallel": "envs.pettingzoo_env",
    "challenges.plan_pictures": "envs.render_modes",
    "challenges.rewards": "envs.rewards",
    "challenges.seen_arrays": "envs.observation_arrays",
    "challenges.session": "envs.session",
    "challenges.single": "envs.gymnasium_env",
    "challenges.slots": "envs.node_slots",
    "challenges.text_protocol": "envs.text_protocol",
    "agents.demonstrations": "agents.demonstration_goals",
    "agents.errands": "agents.distractions",
    "agents.expected_time": "agents.expected_time_helper",
    "agents.faults": "agents.human_faults",
    "agents.forecast": "agents.completion_forecast",
    "agents.heaps": "agents.object_groups",
    "agents.learned": "agents.learned_helpers",
    "agents.online": "agents.online_helper",
    "agents.online_registry": "agents.online_helper_registry",
    "agents.posterior": "agents.goal_posterior",
    "agents.proposed_plans": "agents.proposal_helpers",
    "agents.prospects": "agents.partner_plans",
    "agents.regression": "agents.regression_planning",
    "agents.scene_reading": "agents.policy_observations",
    "agents.shown_choices": "agents.imitation_targets",
    "agents.talking": "agents.communication",
    "agents.watchful": "agents.partial_view_helper",
    "agents.whereabouts": "agents.agent_locations",
    "challenges.guard": "challenges.agent_guard",
    "challenges.lineup": "challenges.episode_agents",
    "challenges.play": "challenges.episode_loop",
    "challenges.playing_demonstrations": "challenges.demonstration_episodes",
    "challenges.practice": "challenges.practice_episodes",
    "challenges.episode_spread": "challenges.parallel_episodes",
    "challenges.solvable": "challenges.solvability",
    "challenges.starts": "challenges.start_worlds",
    "challenges.table_rows": "challenges.challenge_rows",
    "challenges.watching": "challenges.watch_stage",
    "challenges.wire": "challenges.wire_protocol",
    "analysis.agreement": "analysis.precondition_agreement",
    "analysis.augment_figures": "analysis.augmentation_results",
    "analysis.augment_pictures": "analysis.augmentation_charts",
    "analysis.described": "analysis.written_descriptions",
    "analysis.distribution": "analysis.object_distribution",
    "analysis.filmed_pairs": "analysis.program_home_pairs",
    "analysis.helped_people": "analysis.helper_harm",
    "analysis.ideal_reader": "analysis.description_information",
    "analysis.kept_circumstances": "analysis.context_preservation",
    "analysis.ratings": "analysis.completeness_ratings",
    "models.data": "models.text_examples",
    "models.filled": "models.checkpoint_weights",
    "models.predicting": "models.prediction_files",
    "models.scored_rows": "models.method_scores",
    "models.seen_programs": "models.training_overlap",
    "models.showing": "models.prediction_stages",
    "models.tried_programs": "models.execution_trials",
    "models.decoding.options": "models.decoding.next_step_options",
    "models.demonstrations.above_facts": "models.demonstrations.overhead_features",
    "models.demonstrations.kinds_compared": "models.demonstrations.demonstration_comparison",
    "models.films.film_critical": "models.films.film_self_critical",
    "models.films.film_readings": "models.films.instruction_scores",
    "models.films.film_shown": "models.films.film_prediction",
    "models.films.seen_classes": "models.films.mask_features",
    "models.films.seen_clips": "models.films.mask_clips",
    "models.films.seen_model": "models.films.mask_clip_model",
    "models.films.seen_network": "models.films.mask_clip_network",
    "models.films.whole_films": "models.films.film_smoothing",
    "models.sketches.choices": "models.sketches.candidate_choices",
    "models.sketches.chooser": "models.sketches.plan_chooser",
    "models.sketches.grounded": "models.sketches.grounded_programs",
    "models.sketches.ranker": "models.sketches.candidate_ranker",
    "models.sketches.text_clues": "models.sketches.text_features",
    "models.text.first_phase": "models.text.pretrained_model",
    "models.text.likelihood": "models.text.likelihood_training",
    "models.text.mentions": "models.text.object_mentions",
    "models.text.writer": "models.text.program_writer",
    "models.watching.moment_network": "models.watching.state_network",
    "models.watching.sightings": "models.watching.object_sightings",
    "models.watching.thing_network": "models.watching.object_network",
    "models.watching.watched_batches": "models.watching.demonstration_batches",
    "grounding.trial": "grounding.grounded_run",
    "grounding.environments.filling": "grounding.environments.random_objects",
    "grounding.environments.for_goals": "grounding.environments.goal_environments",
    "grounding.environments.partial": "grounding.environments.partial_environment",
    "grounding.environments.placing": "grounding.environments.object_placement",
    "grounding.environments.satisfying": "grounding.environments.condition_satisfaction",
    "grounding.environments.thinning": "grounding.environments.home_thinning",
    "grounding.environments.violating": "grounding.environments.condition_violation",
    "grounding.preconditions.checking": "grounding.preconditions.condition_checks",
    "grounding.preconditions.defaults": "grounding.preconditions.default_conditions",
    "grounding.preconditions.infer": "grounding.preconditions.precondition_inference",
    "homes.exporting": "homes.home_export",
    "homes.forms": "homes.object_shapes",
    "homes.reposing": "homes.moved_boxes",
    "homes.from_graph.arranging": "homes.from_graph.furniture_arrangement",
    "homes.from_graph.embedding": "homes.from_graph.room_embedding",
    "homes.from_graph.measured": "homes.from_graph.layout_from_boxes",
    "homes.from_graph.panels": "homes.from_graph.room_panels",
    "homes.from_graph.parts": "homes.from_graph.graph_places",
    "homes.from_graph.rooms": "homes.from_graph.room_rectangles",
    "homes.from_graph.shown_relations": "homes.from_graph.geometric_relations",
    "homes.plans.checks": "homes.plans.plan_checks",
    "homes.plans.entries": "homes.plans.plan_entries",
    "homes.plans.packing": "homes.plans.object_packing",
    "homes.plans.shell": "homes.plans.home_shell",
    "homes.plans.writing": "homes.plans.plan_writer",
    "homes.procedural.generate": "homes.procedural.home_generator",
    "homes.procedural.stocking": "homes.procedural.furniture_contents",
    "kb.tools.mine": "kb.tools.fact_mining",
    "kb.tools.paths": "kb.tools.relation_paths",
    "kb.tools.reasons": "kb.tools.correction_reasons",
    "repair.causes": "repair.failure_causes",
    "repair.circumstances": "repair.step_context",
    "repair.gist": "repair.activity_steps",
    "repair.loop": "repair.repair_loop",
    "repair.perturb": "repair.perturbation",
    "repair.strengths": "repair.perturbation_strengths",
    "repair.trim": "repair.repair_trimming",
    "repair.variants": "repair.augmentation",
    "schemas.blocks": "schemas.program_boundaries",
    "schemas.explained": "schemas.call_errors",
    "schemas.arguments": "schemas.argument_faults",
    "schemas.located": "schemas.located_yaml",
    "schemas.malformed": "schemas.malformed_steps",
    "scoring.first_faults": "scoring.refused_rows",
    "scoring.lines": "scoring.line_sequences",
    "scoring.metrics.counts": "scoring.metrics.precision_recall",
    "pipelines.checks.checked_text": "pipelines.checks.text_checks",
    "pipelines.checks.programs": "pipelines.checks.program_checks",
    "pipelines.checks.special": "pipelines.checks.free_text_steps",
    "pipelines.crowd.repeated": "pipelines.crowd.duplicate_records",
    "pipelines.crowd.seen": "pipelines.crowd.key_counts",
    "pipelines.engine.context": "pipelines.engine.build_context",
    "pipelines.engine.overlays": "pipelines.engine.user_overlays",
    "pipelines.engine.deadline": "pipelines.engine.record_deadline",
    "commands.film_read": "commands.film_output",
    "commands.model_shown": "commands.model_output",
    "rendering.cameras.candidates": "rendering.cameras.camera_candidates",
    "rendering.cameras.sight": "rendering.cameras.visibility_estimates",
    "rendering.film.contact": "rendering.film.contact_sheet",
    "rendering.film.cuts": "rendering.film.shot_sequence",
    "rendering.film.quality": "rendering.film.film_measures",
    "rendering.film.quiet": "rendering.film.stderr_suppression",
    "rendering.film.replay": "rendering.film.replay_3d",
    "rendering.film.walks": "rendering.film.film_walks",
    "rendering.models.look": "rendering.models.appearance",
    "rendering.models.looks": "rendering.models.class_appearance",
    "rendering.models.sheet": "rendering.models.model_sheet",
    "rendering.models.weave": "rendering.models.texture_patterns",
    "rendering.models.drape": "rendering.models.blanket",
    "rendering.models.leaf": "rendering.models.plant_leaf",
    "rendering.people.acting": "rendering.people.action_poses",
    "rendering.people.aims": "rendering.people.palm_targets",
    "rendering.people.arrivals": "rendering.people.object_arrivals",
    "rendering.people.blends": "rendering.people.pose_blends",
    "rendering.people.dressed": "rendering.people.clothed_body",
    "rendering.people.lying": "rendering.people.lying_down",
    "rendering.people.pacing": "rendering.people.motion_timing",
    "rendering.people.shape": "rendering.people.body_shape",
    "rendering.people.tracks": "rendering.people.motion_tracks",
    "rendering.people.variety": "rendering.people.random_people",
    "rendering.people.worn": "rendering.people.headwear",
    "rendering.rays.casting": "rendering.rays.ray_casting",
    "rendering.rays.fine": "rendering.rays.fine_pictures",
    "rendering.rays.flow": "rendering.rays.optical_flow",
    "rendering.rays.incremental": "rendering.rays.incremental_pictures",
    "rendering.rays.maps": "rendering.rays.pixel_maps",
    "rendering.rays.memory": "rendering.rays.reused_arrays",
    "rendering.rays.shot": "rendering.rays.camera_shot",
    "rendering.scene.history": "rendering.scene.graph_history",
    "rendering.scene.locations": "rendering.scene.object_locations",
    "rendering.scene.places": "rendering.scene.object_boxes",
    "rendering.scene.prepared": "rendering.scene.scene_preparation",
    "rendering.scene.swept": "rendering.scene.door_sweep",
    "rendering.scene.variation": "rendering.scene.film_variation",
    "rendering.scene.with_geometry": "rendering.scene.home_geometry",
    "agents.distances": "agents.walk_distances",
    "agents.hierarchical": "agents.hierarchical_helper",
    "agents.population": "agents.human_population",
    "challenges.channels": "challenges.agent_channels",
    "challenges.definition": "challenges.challenge_definition",
    "homes.drawing": "homes.floor_plan_drawing",
    "homes.statistics": "homes.home_statistics",
    "kb.records": "kb.knowledge_records",
    "pipelines.crowd.known_descriptions": "pipelines.crowd.description_lookup",
    "pipelines.engine.estimates": "pipelines.engine.build_estimates",
    "rendering.models.expressions": "rendering.models.model_expressions",
    "rendering.models.interpreter": "rendering.models.model_interpreter",
    "rendering.models.pictures": "rendering.models.object_pictures",
    "rendering.models.recipes": "rendering.models.model_recipes",
    "rendering.people.holding": "rendering.people.held_objects",
    "rendering.people.pushing": "rendering.people.pushed_objects",
    "rendering.people.reaching": "rendering.people.hand_reach",
    "rendering.people.stepping": "rendering.people.foot_steps",
    "rendering.rays.lamplight": "rendering.rays.surface_lighting",
    "rendering.rays.rasterising": "rendering.rays.rasterizer",
    "rendering.rays.still_cameras": "rendering.rays.fixed_cameras",
    "rendering.rays.unshaded_groups": "rendering.rays.unshadowed_groups",
    "datasets.damage": "datasets.damage_faults",
    "datasets.questions": "datasets.read_only_sql",
    "datasets.steady": "datasets.consistent_reads",
    "datasets.program_entries": "datasets.published_program",
    "datasets.format.cases": "datasets.format.case_rows",
    "datasets.format.texts": "datasets.format.compact_texts",
    "datasets.report.stories": "datasets.report.program_pages",
    "datasets.report.write": "datasets.report.report_writer",
    "datasets.export.code": "datasets.export.python_code",
    "datasets.export.triples": "datasets.export.rdf",
    "kb.language.phrases": "kb.language.step_phrases",
    "kb.language.understanding": "kb.language.step_understanding",
    "pipelines.readers.columns": "pipelines.readers.field_columns",
    "pipelines.readers.document": "pipelines.readers.json_documents",
    "pipelines.readers.elements": "pipelines.readers.json_elements",
    "pipelines.readers.item": "pipelines.readers.reader_items",
    "pipelines.readers.ours": "pipelines.readers.json_records",
    "pipelines.readers.published": "pipelines.readers.published_dataset",
    "pipelines.readers.recognise": "pipelines.readers.recognition_by_content",
    "pipelines.readers.text": "pipelines.readers.program_text",
    "pipelines.readers.scenes": "pipelines.readers.scene_graphs",
    "simulation.explain": "simulation.step_explanations",
    "simulation.holds": "simulation.literal_truth",
    "simulation.actions.metres": "simulation.actions.metric_checks",
    "simulation.actions.modified": "simulation.actions.modifier_effects",
    "simulation.motion.making_ways": "simulation.motion.distance_field_jobs",
    "simulation.motion.stored_ways": "simulation.motion.stored_distance_fields",
    "simulation.observation.as_seen": "simulation.observation.masked_world",
    "simulation.world.building": "simulation.world.home_building",
    "simulation.world.derived": "simulation.world.derived_homes",
    "simulation.world.fitting": "simulation.world.placement_fit",
    "simulation.world.moved": "simulation.world.moved_edges",
    "simulation.world.touched": "simulation.world.changed_nodes",
    "storage.exchange": "storage.folder_exchange",
    "storage.fetching": "storage.url_fetching",
    "studies.conduct": "studies.study_progress",
    "studies.filming": "studies.judged_film_files",
    "studies.prepare": "studies.study_preparation",
    "studies.simulate": "studies.study_simulation",
    "web.front": "web.start_pages",
    "web.link": "web.person_socket",
    "web.visit": "web.room_request",
    "web.annotate.composing": "web.annotate.program_stage",
    "web.annotate.draft": "web.annotate.program_draft",
    "web.annotate.marking": "web.annotate.annotation_marks",
    "web.annotate.reviewing": "web.annotate.review_stage",
    "web.play.remembered": "web.play.player_memory",
    "web.play.trials": "web.play.play_trials",
    "schemas.change": "schemas.graph_change",
    "schemas.decoding": "schemas.text_decoding",
    "schemas.libraries": "schemas.optional_libraries",
    "schemas.yaml_extent": "schemas.yaml_limits",
    "kb.groups": "kb.action_groups",
    "kb.grammar": "kb.action_grammar",
    "models.films.clip_tables": "models.films.clip_result_tables",
    "pipelines.readers.spreadsheets": "pipelines.readers.program_tables",
    "studies.judged_films": "studies.films_to_judge",
    "studies.judged_programs": "studies.programs_to_judge",
}
"""The module of today for each module that was renamed or moved, both without `hearth.`."""

_PACKAGE = __name__.partition(".")[0]


class OldModules(MetaPathFinder):
    """Finds modules by the names of `MODULES`; Python asks it last, for modules that no other finder has."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the specification of a module of an earlier version."""
        package, _, module = fullname.partition(".")
        if package != _PACKAGE or module not in MODULES:
            return None
        return ModuleSpec(fullname, OldModule(f"{package}.{MODULES[module]}"))


class OldModule(Loader):
    """Gives an old name the very module of today, so that its classes stay one.

    Attributes:
        today: the full name of that module.
    """

    def __init__(self, today: str) -> None:
        self.today = today

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """Leave it to Python to make the empty module."""
        return None

    def exec_module(self, module: ModuleType) -> None:
        """Replace an empty module of the old name by the module of today."""
        warnings.warn(f"{module.__name__} is now {self.today}", DeprecationWarning, stacklevel=2)
        sys.modules[module.__name__] = import_module(self.today)

    def get_code(self, fullname: str) -> CodeType | None:
        """Return the code of the module of today, for `python -m` with an old name."""
        from importlib.util import find_spec

        warnings.warn(f"{fullname} is now {self.today}", DeprecationWarning, stacklevel=2)
        found = find_spec(self.today)
        loader: Any = found.loader if found else None
        code: CodeType | None = loader.get_code(self.today) if loader else None
        return code


def install() -> None:
    """Let old names be imported; once, however often it is called."""
    if not any(isinstance(finder, OldModules) for finder in sys.meta_path):
        sys.meta_path.append(OldModules())
