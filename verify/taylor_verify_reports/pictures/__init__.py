"""Pictures of studies that no user of taylor_verify draws."""
