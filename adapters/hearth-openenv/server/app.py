"""The server as an application: `server --port 8000`, or `uvicorn hearth_openenv.server.app:app`."""

import argparse

import uvicorn
from fastapi import Request
from fastapi.responses import JSONResponse
from hearth_openenv.models import HearthAction, HearthObservation, HearthState
from hearth_openenv.server.hearth_environment import HearthEnvironment
from openenv.core.env_server.http_server import create_app

import hearth

MOST = 64
"""Sessions at once."""

app = create_app(
    HearthEnvironment, HearthAction, HearthObservation, env_name="hearth", max_concurrent_envs=MOST,
    state_cls=HearthState,
)  # fmt: skip


@app.exception_handler(ValueError)
@app.exception_handler(hearth.HearthError)
async def refused(request: Request, error: Exception) -> JSONResponse:
    """Return bad input as the library's own errors of validation are returned."""
    return JSONResponse({"detail": str(error)}, 422)


def main() -> None:
    """Serve until interrupted."""
    parser = argparse.ArgumentParser(description="Serve household tasks of Hearth to OpenEnv.")
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=8000)
    given = parser.parse_args()
    uvicorn.run(app, host=given.host, port=given.port)


if __name__ == "__main__":
    main()
