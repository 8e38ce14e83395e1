"""Actions, one function each, grouped by the kind of their objects; `registry` names them all."""
