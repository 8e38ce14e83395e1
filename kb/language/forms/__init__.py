"""The forms in which steps are written, one module each; `form_registry` has them all."""
