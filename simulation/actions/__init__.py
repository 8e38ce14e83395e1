"""One function an action, grouped by what is acted on; `registry` names them all."""
