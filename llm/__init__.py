"""Language models: endpoints with a cache and a budget, prompts, planners, actors, helpers, judges."""
