# Short names for the scripts under tools/, which also run where make is not installed yet.
.PHONY: demo test check bench bench-growth bench-peers bench-attributes
demo:
	@tools/demo "$(IN)"
test:
	@tools/test
check:
	@tools/check fast
bench:
	@IN="$(IN)" tools/bench
bench-growth:
	@tools/bench_growth
bench-peers:
	@tools/bench_peers
bench-attributes:
	@tools/bench_attributes
