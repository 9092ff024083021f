"""heyoka's adaptive Taylor integrator, driven so that it cannot be silently wrong."""
