"""What agents can see and reach."""
